// export/cfradial_layout.h -- which variables and range axes a volume needs; internal to export.
//
// Gates are written where they were measured. So the gates of a moment that agree in first gate,
// spacing, word size, scale and offset make one field, and each pair of first gate and spacing one
// range axis. Nearly every moment of a modern volume is one field on the one axis.
//   names   the kind of a moment that most radials have is REF; the others are REF_2, REF_3, ...;
//           axes are range, range_2, ... in the order in which the fields need them
//   order   of the moments (REF VEL SW ZDR PHI RHO CFP), then by radials, then as in the file
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::netcdf {

struct RangeAxis {
    std::string name;
    std::int32_t first_gate_m = 0;  // to the centre
    std::int32_t gate_spacing_m = 0;
    std::size_t gates = 0;  // the most of any radial
};

struct CfradialField {
    std::string name;
    std::size_t axis = 0;  // of CfradialLayout::axes
    // One element a sweep of the volume; null where the sweep lacks this kind. Never all null.
    std::vector<const level2::SweepMoment*> sweeps;
    const level2::SweepMoment* kind = nullptr;  // the first of them: what all agree in
    std::size_t radials = 0;                    // that have gates of this kind
};

struct CfradialLayout {
    std::vector<RangeAxis> axes;  // at least one, perhaps without gates
    std::vector<CfradialField> fields;
    std::vector<std::size_t> first_radials;  // of each sweep, counted through the volume
    std::size_t radials = 0;
};

// Real volumes need at most ten fields; more than this is a damaged file.
inline constexpr std::size_t most_cfradial_fields = 64;

// The volume must outlive the layout, which points into it.
// Errors: bad_argument for a sweep without radials or whose arrays do not fit each other;
// unsupported for more than most_cfradial_fields fields.
[[nodiscard]] Result<CfradialLayout> lay_out(const level2::Volume& volume);

}  // namespace stormcellar::netcdf
