mod damping;
mod momentum_laws;
mod poisson;
mod single_precision;
mod steady_turns;
