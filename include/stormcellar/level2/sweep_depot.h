// stormcellar/level2/sweep_depot.h -- an interface that stores sweeps, or parts of sweeps, outside
// the decoder.
//
// Threads   Each implementation states its own contract.
// Errors    See each function.
#pragma once

#include <cstdint>
#include <optional>

#include "stormcellar/base/interface.h"
#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

class SweepDepot : public Interface {
  public:
    // Stores a sweep and returns its place. Returns none if there is no room; the caller then keeps
    // the sweep.
    [[nodiscard]] virtual std::optional<std::uint64_t> put(const Sweep& sweep) = 0;
    // Returns, bit for bit, the sweep that put() stored at `place`. Errors: io, corrupt.
    [[nodiscard]] virtual Result<Sweep> get(std::uint64_t place) const = 0;
};

}  // namespace stormcellar::level2
