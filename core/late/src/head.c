/* A step of NAME on GROUP. Compile with -ffp-contract=off.

   int liestep_make(Stepper *, const double *parameters, double h);       0 where h or a parameter can't be used
   void liestep_start(const Stepper *, State *, const double *attitude, const double *momentum, const double *velocity);
   int liestep_step(const Stepper *, State *);                            0 where nothing was done
COMPOSED   double liestep_defect(const State *);                                  how far the attitude is from the group

   The attitude is a matrix for each factor, row by row, that maps body to space components; the momentum and the velocity that it
   determines are in the body frame. The numbers of the parameters, those of a matrix row by row:
