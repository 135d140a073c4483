mod contragredient;
mod digest;
mod momentum_laws;
mod poisson;
mod two_flows;
