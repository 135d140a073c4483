mod damping;
mod momentum_laws;
mod poisson;
mod steady_turns;
