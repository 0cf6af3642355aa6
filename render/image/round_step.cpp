#include "render/image/round_step.h"

#include <cmath>
#include <initializer_list>

namespace stormcellar::render {

double round_step(double range, int most_steps) {
    const double least = range / most_steps;
    const double power = std::pow(10.0, std::floor(std::log10(least)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor * power >= least * (1 - 1e-9)) return factor * power;
    }
    return 10 * power;
}

}  // namespace stormcellar::render
