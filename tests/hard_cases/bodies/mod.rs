mod body_axes;
mod free_bodies;
mod inertia;
