// stormcellar/render/integration.h -- how the values between two slices make up a step.
#pragma once

#include <string_view>

namespace stormcellar::render {

//   riemann       the nearer value alone. First order in the step
//   first_order   all values between the two ends, mixed by their extinction: what the near part of
//                 the step hides of its far part is left out
//   second_order  all values between, in their order: the integral over a straight change from
//                 one end to the other (Engel, Kraus, Ertl 2001). Second order
enum class Integration { riemann, first_order, second_order };
// "riemann", "pre-integrated", "pre-integrated-2".
[[nodiscard]] std::string_view integration_name(Integration integration);

}  // namespace stormcellar::render
