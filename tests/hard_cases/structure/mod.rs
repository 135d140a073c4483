mod damping;
mod steady_turns;
