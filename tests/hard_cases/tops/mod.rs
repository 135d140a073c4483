mod long_run;
mod modified_hamiltonian;
mod no_gravity;
mod order;
mod sleeping_top;
mod tiny_step;
mod unit_scaling;
mod vertical_passage;
