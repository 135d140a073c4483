mod euler_angles;
mod inertia;
