/* A host of a unit: ./host UNIT TOKEN STEP COUNT MODE MOMENTUM ENERGY INPUT prints momentum and energy after each step. */
#include <dlfcn.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *library;
static void *named(const char *name) {
    void *function = dlsym(library, name);
    if (!function) {
        fprintf(stderr, "no %s\n", name);
        exit(9);
    }
    return function;
}
#define CALL(type, name) (*(type *)(void *[]){named(name)})
typedef int Moved(void *, const uint32_t *, size_t, double *, size_t);
typedef int Step(void *, double, double, bool, bool *, bool *, bool *, double *);
typedef int Plain(void *);
typedef int Stored(void *, void **);
typedef int Restored(void *, void *);

static double h;
static uint32_t momentum, energy, input;
static int step(void *unit, int at, double length) {
    bool event, ends, early;
    double last;
    return CALL(Step *, "fmi3DoStep")(unit, at * h, length, true, &event, &ends, &early, &last);
}
static void show(void *unit) {
    double values[4];
    if (CALL(Moved *, "fmi3GetFloat64")(unit, (uint32_t[]){momentum, energy}, 2, values, 4)) exit(3);
    printf("%.17g,%.17g,%.17g,%.17g\n", values[0], values[1], values[2], values[3]);
}

int main(int count_of, char **given) {
    if (count_of != 9) return 8;
    library = dlopen(given[1], RTLD_NOW);
    if (!library) return 7;
    h = atof(given[3]);
    const int count = atoi(given[4]);
    const char *mode = given[5];
    momentum = (uint32_t)atoi(given[6]), energy = (uint32_t)atoi(given[7]), input = (uint32_t)atoi(given[8]);
    typedef void *Made(const char *, const char *, const char *, bool, bool, bool, bool, const uint32_t *, size_t, void *, void *, void *);
    typedef int Begun(void *, bool, double, double, bool, double);
    typedef int Size(void *, void *, size_t *);
    typedef int Bytes(void *, void *, uint8_t *, size_t);
    typedef int FromBytes(void *, const uint8_t *, size_t, void **);
    Made *make = CALL(Made *, "fmi3InstantiateCoSimulation");
    if (make("unit", "of another text", "", 0, 0, 0, 0, 0, 0, 0, 0, 0)) return 6;
    void *unit = make("unit", given[2], "", 0, 0, 0, 0, 0, 0, 0, 0, 0), *state = NULL;
    if (!unit || CALL(Begun *, "fmi3EnterInitializationMode")(unit, 0, 0, 0, 0, 0)) return 5;
    if (CALL(Plain *, "fmi3ExitInitializationMode")(unit)) return 4;
    size_t size;
    CALL(Size *, "fmi3SerializedFMUStateSize")(unit, NULL, &size);
    uint8_t *bytes = malloc(size), *others = malloc(size);
    int from = 0;
    if (!strcmp(mode, "resumed")) {
        FILE *file = fopen("state.bin", "rb");
        if (!file || fread(bytes, 1, size, file) != size || fclose(file)) return 20;
        if (CALL(FromBytes *, "fmi3DeserializeFMUState")(unit, bytes, size, &state)) return 21;
        if (CALL(Restored *, "fmi3SetFMUState")(unit, state)) return 22;
        from = count / 2;
    } else {
        printf("names\n");
        show(unit);
    }
    for (int n = from; n < count; n++) {
        if (!strcmp(mode, "rolled-back") && n % 10 == 3) {
            if (CALL(Stored *, "fmi3GetFMUState")(unit, &state)) return 23;
            for (int k = 0; k < 5; k++) if (step(unit, n + k, h)) return 24;
            if (CALL(Restored *, "fmi3SetFMUState")(unit, state)) return 25;
        }
        if (!strcmp(mode, "refused")) {
            void *after = NULL;
            if (CALL(Stored *, "fmi3GetFMUState")(unit, &state) || CALL(Bytes *, "fmi3SerializeFMUState")(unit, state, bytes, size)) return 26;
            if (step(unit, n, 1.5 * h) != 3 || step(unit, n, 0.0) != 3 || step(unit, n, -h) != 3) return 27;
            if (CALL(Stored *, "fmi3GetFMUState")(unit, &after) || CALL(Bytes *, "fmi3SerializeFMUState")(unit, after, others, size)) return 28;
            if (memcmp(bytes, others, size)) return 29;
            CALL(Stored *, "fmi3FreeFMUState")(unit, &after);
        }
        if (!strcmp(mode, "stored") && n == count / 2) {
            FILE *file = fopen("state.bin", "wb");
            if (CALL(Stored *, "fmi3GetFMUState")(unit, &state) || CALL(Bytes *, "fmi3SerializeFMUState")(unit, state, bytes, size)) return 30;
            if (!file || fwrite(bytes, 1, size, file) != size || fclose(file)) return 31;
        }
        if (!strcmp(mode, "torque")) {
            double torque[3] = {0.0, 0.0, n < count / 2 ? 0.25 : -0.125};
            if (CALL(Moved *, "fmi3SetFloat64")(unit, &input, 1, torque, 3)) return 32;
        }
        /* Two steps at once have the bits of two. */
        const int length = !strcmp(mode, "pairs") ? 2 : 1;
        if (step(unit, n, length * h)) return 33;
        n += length - 1;
        show(unit);
    }
    typedef void Freed(void *);
    CALL(Freed *, "fmi3FreeInstance")(unit);
    return 0;
}
