mod at_rest;
mod no_step_limit;
mod reversal;
mod step_scan;
mod wrong_root;
