/* A step of NAME on GROUP. Compile with -ffp-contract=off.

   int $make($stepper *, const double *parameters, double h);
       0 where h or a parameter can't be used
   void $start(const $stepper *, $state *, const double *attitude, const double *momentum, const double *velocity);
   int $step(const $stepper *, $state *);
       0 where nothing was done
   int $give($stepper *, $state *, const double *parameters);
       other parameters between two steps; 0 where they can't be used and nothing was done
COMPOSEDLIMITED   double $defect(const $state *);
       how far the attitude is from the group

COMPENSATED    Sums are compensated: what rounding takes from attitude, momentum and advected values is added to their next changes.
   The attitude is a matrix for each factor, row by row, that maps body to space components; the momentum and the velocity that it
   determines are in the body frame. A solve has at most @ITERATIONS iterations, which may be defined before this text, and a step
   that takes more is refused. The numbers of the parameters, those of a matrix row by row:
PARAMETER_PLACES
*/
MATHEMATICS
#ifndef @DECLARED
#define @DECLARED

enum {
    SIZES
};

typedef struct {
    double h, safe, largest;
    double parameters[@PARAMETERS], constants[@CONSTANTS];
} $stepper;

typedef struct {
    double attitude[@ENTRIES], momentum[@N], advected[@ADVECTED];
    double history[2 * @N], guess[@N];
COMPENSATED     double errors[@CHANGES];
    COUNT steps;
} $state;

PROTOTYPES
#endif

#ifndef @ITERATIONS
#define @ITERATIONS 20
#endif
#define @EPSILON 2.220446049250313e-16

typedef struct {
    double h;
    const double INPUTS;
} $inputs;

