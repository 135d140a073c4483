mod body_axes;
mod closed_forms;
mod inertia;
mod order;
