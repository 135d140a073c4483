mod at_rest;
mod step_scan;
