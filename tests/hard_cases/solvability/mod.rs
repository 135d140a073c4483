mod at_rest;
mod reversal;
mod step_scan;
mod wrong_root;
