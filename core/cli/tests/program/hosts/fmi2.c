/* A host of a unit of FMI 2.0: ./host UNIT TOKEN STEP COUNT MODE MOMENTUM ENERGY INPUT. */
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>

static void *library;
#define CALL(type, name) (*(type *)(void *[]){dlsym(library, name)})
typedef int Real(void *, const unsigned *, size_t, double *);
typedef int Step(void *, double, double, int);
typedef int Plain(void *);

int main(int count_of, char **given) {
    if (count_of != 9 || !(library = dlopen(given[1], RTLD_NOW))) return 8;
    const double h = atof(given[3]);
    const unsigned first = (unsigned)atoi(given[6]), last = (unsigned)atoi(given[7]);
    const unsigned places[4] = {first, first + 1, first + 2, last};
    typedef void *Made(const char *, int, const char *, const char *, const void *, int, int);
    typedef int Set(void *, int, double, double, int, double);
    void *unit = CALL(Made *, "fmi2Instantiate")("unit", 1, given[2], "", NULL, 0, 0);
    if (!unit || CALL(Set *, "fmi2SetupExperiment")(unit, 0, 0, 0, 0, 0)) return 7;
    if (CALL(Plain *, "fmi2EnterInitializationMode")(unit) || CALL(Plain *, "fmi2ExitInitializationMode")(unit)) return 6;
    printf("names\n");
    for (int n = 0; n <= atoi(given[4]); n++) {
        double v[4];
        if (CALL(Real *, "fmi2GetReal")(unit, places, 4, v)) return 5;
        printf("%.17g,%.17g,%.17g,%.17g\n", v[0], v[1], v[2], v[3]);
        if (n < atoi(given[4]) && CALL(Step *, "fmi2DoStep")(unit, n * h, h, 1)) return 4;
    }
    return 0;
}
