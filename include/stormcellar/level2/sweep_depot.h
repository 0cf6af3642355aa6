// stormcellar/level2/sweep_depot.h -- where sweeps, or parts of them, lie until they are wanted
// again.
#pragma once

#include <cstdint>
#include <optional>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

// Thread contract: that of its user.
class SweepDepot {
  public:
    SweepDepot() = default;
    SweepDepot(const SweepDepot&) = delete;
    SweepDepot& operator=(const SweepDepot&) = delete;
    virtual ~SweepDepot() = default;

    // None where there is no room: the caller keeps it.
    [[nodiscard]] virtual std::optional<std::uint64_t> put(const Sweep& sweep) = 0;
    // Bit for bit what was put there. Errors: io, corrupt.
    [[nodiscard]] virtual Result<Sweep> get(std::uint64_t place) const = 0;
};

}  // namespace stormcellar::level2
