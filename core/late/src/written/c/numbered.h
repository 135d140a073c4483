
/* The step with its numbers: its stages, the start, and a step from a state, 0 where nothing was done. */
#ifndef @STAGES
#define @STAGES STAGE_COUNT
extern const $stepper $stages[@STAGES];
void $begin($state *state);
int $next($state *state);
#endif
