mod body_axes;
mod closed_forms;
mod flip_period;
mod free_bodies;
mod inertia;
