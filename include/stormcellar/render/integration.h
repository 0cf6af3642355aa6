// stormcellar/render/integration.h -- how a ray adds up the values between two slices (one step).
//
// Threads   Plain values.
// Errors    None.
#pragma once

#include <string_view>

namespace stormcellar::render {

//   riemann       Uses only the nearer value. The error is of first order in the step.
//   first_order   Mixes all values between the two ends, each weighted by its extinction. The mix
//                 ignores that the near part of the step hides the far part.
//   second_order  Uses all values in their order: the integral over a straight change from one end
//                 to the other (Engel, Kraus, Ertl 2001). The error is of second order.
enum class Integration { riemann, first_order, second_order };
// Returns "riemann", "pre-integrated" or "pre-integrated-2".
[[nodiscard]] std::string_view integration_name(Integration integration);

}  // namespace stormcellar::render
