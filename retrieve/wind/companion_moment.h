// retrieve/wind/companion_moment.h -- finds another moment at the gates of a velocity sweep.
//
// The moment comes from the sweep itself, or, because a Doppler cut may lack it, from the sweep of
// nearest elevation, at most 0.3 degrees away. The nearest radial and the nearest gate count.
//
// Units     Degrees and meters; values in the unit of the moment.
// Threads   Pure functions. A CompanionMoment refers to the volume, which must outlive it.
#pragma once

#include <cstdint>
#include <vector>

#include "retrieve/dealias/velocity_sheet.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::retrieve {

class CompanionMoment {
  public:
    CompanionMoment(const level2::Volume& volume, level2::Moment moment,
                    const VelocitySheet& sheet);

    // Returns the value at a gate of the sheet, or NaN if there is none.
    [[nodiscard]] float at(int radial, double range_m) const;

  private:
    const level2::SweepMoment* moment_ = nullptr;
    std::vector<std::int32_t> radials_;  // for each radial of the sheet; -1: none is near
};

}  // namespace stormcellar::retrieve
