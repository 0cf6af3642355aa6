// Reads a Level II file by the C interface, and prints the strongest echo of each sweep.
//   cc -std=c99 strongest_echo.c -lstormcellar && ./a.out FILE
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <stormcellar.h>

static int fail(const stormcellar_error* error) {
    fprintf(stderr, "%s\n", error->message);
    return 1;
}

// Prints the strongest value of a moment of a sweep. Returns 1 after an error.
static int print_strongest(const stormcellar_volume* volume, int32_t sweep, int32_t moment,
                           stormcellar_error* error) {
    stormcellar_sweep_facts facts = {.size = sizeof facts};
    stormcellar_moment_facts gates = {.size = sizeof gates};
    if (stormcellar_sweep_describe(volume, sweep, &facts, error) ||
        stormcellar_moment_describe(volume, sweep, moment, &gates, error))
        return fail(error);
    const size_t count = (size_t)facts.radials * (size_t)gates.gates;
    float* const values = malloc(count * sizeof *values);
    stormcellar_radial* const radials = malloc((size_t)facts.radials * sizeof *radials);
    if (!values || !radials ||
        stormcellar_moment_values(volume, sweep, moment, values, count, error) ||
        stormcellar_sweep_radials(volume, sweep, radials, (size_t)facts.radials, error)) {
        free(values);
        free(radials);
        return fail(error);
    }
    float strongest = -100;
    size_t place = 0;
    for (size_t i = 0; i < count; ++i) {
        if (isnan(values[i]) || values[i] <= strongest) continue;
        strongest = values[i];
        place = i;
    }
    const size_t radial = place / (size_t)gates.gates, gate = place % (size_t)gates.gates;
    printf("elevation %5.2f degrees: %5.1f %s at azimuth %5.1f degrees, range %5.1f km\n",
           facts.elevation_deg, strongest, gates.unit, radials[radial].azimuth_deg,
           (gates.first_gate_m + (double)gates.gate_spacing_m * (double)gate) / 1000);
    free(values);
    free(radials);
    return 0;
}

int main(int argc, char** argv) {
    if (argc != 2) {
        fprintf(stderr, "usage: strongest_echo FILE\n");
        return 2;
    }
    stormcellar_error error = {0, ""};
    stormcellar_read_options options = {.size = sizeof options, .moments = "REF"};
    stormcellar_volume* volume = NULL;
    if (stormcellar_volume_open(argv[1], &options, &volume, &error)) return fail(&error);
    stormcellar_volume_facts facts = {.size = sizeof facts};
    int failed = stormcellar_volume_describe(volume, &facts, &error) ? fail(&error) : 0;
    if (!failed) printf("%s, %s\n", facts.station, facts.complete ? "complete" : "not complete");
    for (int32_t sweep = 0; sweep < facts.sweeps && !failed; ++sweep) {
        int32_t moment = 0;
        if (stormcellar_moment_find(volume, sweep, "REF", &moment, &error)) continue;
        failed = print_strongest(volume, sweep, moment, &error);
    }
    stormcellar_volume_free(volume);
    return failed;
}
