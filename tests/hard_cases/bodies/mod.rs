mod body_axes;
mod closed_forms;
mod euler_angles;
mod inertia;
mod order;
