mod contragredient;
mod damping;
mod digest;
mod momentum_laws;
mod poisson;
mod two_flows;
