// export/cfradial_layout.h -- finds the variables and range axes that a volume needs; internal to
// export.
//
// With one range axis for the volume (RangeAxes), the gates of a moment that agree in word size,
// scale and offset make one field. With several range axes, they must also agree in first gate and
// spacing, and each pair of first gate and spacing makes an axis. Either way, nearly every moment
// of a modern volume is one field on one axis.
//   names   Gates of a moment that make one field are of one kind. The kind that most radials have
//           is named as the moment, such as REF; the other kinds are REF_2, REF_3, .... The caller
//           chooses the names of the moments. Axes are range, range_2, ... in the order in which
//           the fields need them.
//   order   Fields are sorted by moment (REF VEL SW ZDR PHI RHO CFP), then by number of radials,
//           then by the place at which they first appear in the file.
//
// Threads   Plain data and a pure function.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/export/cfradial.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::netcdf {

struct RangeAxis {
    std::string name;
    std::int32_t first_gate_m = 0;  // to the center of the gate
    std::int32_t gate_spacing_m = 0;
    std::size_t gates = 0;  // number of elements, enough for the longest radial
};

// The place of one sweep's gates on the axis of their field. Gate i fills the elements from first +
// i * repeats to first + (i + 1) * repeats - 1.
struct GatePlacement {
    std::size_t first = 0;
    std::size_t repeats = 1;
};

// Names of a moment in one version of CfRadial. The standard name may be empty.
struct FieldNames {
    std::string_view name;
    std::string_view standard_name;
};

[[nodiscard]] FieldNames names_in_cfradial_1(level2::Moment moment);

struct CfradialField {
    std::string name;
    std::string_view standard_name;
    std::size_t axis = 0;  // index in CfradialLayout::axes
    // One element for each sweep. It is null if the sweep has no gates of this kind.
    // At least one element is not null.
    std::vector<const level2::SweepMoment*> sweeps;
    const level2::SweepMoment* kind = nullptr;  // the first of `sweeps` that is not null
    std::size_t radials = 0;                    // number of radials that have gates of this kind
};

struct CfradialLayout {
    std::vector<RangeAxis> axes;  // at least one axis, but it may have no gates
    std::vector<CfradialField> fields;
    // For each sweep, the number of its first radial among the radials of all sweeps.
    std::vector<std::size_t> first_radials;
    std::size_t radials = 0;
};

// Real volumes need at most ten fields. A volume that needs more than this number is damaged.
inline constexpr std::size_t most_cfradial_fields = 64;

// Returns the place of a moment's gates on an axis of the layout. The gates must fit onto the axis.
[[nodiscard]] GatePlacement place_gates(const RangeAxis& axis, const level2::SweepMoment& moment);

// Returns the one axis onto which all gates of these sweeps fit; none if there is no such axis.
[[nodiscard]] std::optional<RangeAxis> common_axis(std::span<const level2::Sweep> sweeps);

// Fails with bad_argument if a sweep has no radials, or arrays that do not fit each other.
[[nodiscard]] Status check_sweeps(std::span<const level2::Sweep> sweeps);

// Makes the layout. It refers to the sweeps, which must outlive it. Errors: those of
// check_sweeps(); unsupported for more than most_cfradial_fields fields.
[[nodiscard]] Result<CfradialLayout> lay_out(
    std::span<const level2::Sweep> sweeps, RangeAxes ranges,
    FieldNames (*names)(level2::Moment) = names_in_cfradial_1);

}  // namespace stormcellar::netcdf
