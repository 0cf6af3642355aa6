// stormcellar/retrieve/derived_moments.h -- the moments that come from other moments: VELD, the
// dealiased velocity; SRV, the dealiased velocity relative to a storm; AZSH, the azimuthal shear,
// and DIVG, the radial divergence, of the dealiased velocity; POW, the probability of weather
// (quality.h); KDP, the specific differential phase (kdp.h); RATE, the rain rate (rain_rate.h);
// HCA, the hydrometeor class (hydrometeors.h).
//
// SRV is VELD minus the part of the storm's horizontal motion along the beam,
//     (u sin a + v cos a) cos e
// where a and e are azimuth and elevation of the radial. Like VELD, SRV is positive away from the
// radar, comes in steps of 0.01 m/s, and keeps the flags of VEL. A gate of SRV is ambiguous where
// VELD is ambiguous, and where its velocity would exceed 320 m/s.
//
// AZSH and DIVG are the results of sweep_shear() with its usual options (velocity_shear.h). They
// are in units of 0.001 s^-1 in steps of 1e-5 s^-1, and keep the flags of VEL. A gate with echo is
// ambiguous where VELD is ambiguous, where no plane can be fitted, and where the value would exceed
// 0.32 s^-1.
//
// KDP has the gates and the flags of PHI, in steps of 0.005 degrees/km; a gate with a phase is
// ambiguous where no KDP can be fitted, or where the error of KDP exceeds 1 degree/km. RATE has the
// gates and the flags of REF, in steps of 0.02 mm/h up to 1300; a sweep without PHI takes KDP from
// the nearest sweep that has PHI.
//
// HCA has the gates and the flags of REF in sweeps with dual polarization, and its values are
// numbers of classes. A gate is ambiguous where no class fits. A note gives the melting layer.
//
// Units     As in storm_motion.h. The motion is rounded to whole degrees and to 0.1 m/s before its
//           use, so that the text of the motion is exact.
// Accuracy  AZSH, DIVG: the accuracy of sweep_shear(), and half a step
//           (tests/retrieve/shear_moments_test.cpp). SRV: 0.01 m/s for the given motion, which is
//           half a step of VELD and half a step of SRV (tests/retrieve/derived_moments_test.cpp).
//           Not covered: an error of the motion itself, which changes all velocities of a radial
//           alike; the vertical motion of the storm; and storms of one volume that move
//           differently.
// Errors    bad_argument if dealiasing is off; not_found, with the reason, if the volume has no
//           velocities, or if SRV is wanted and the wind profile gives no motion.
// Threads   Pure functions.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/retrieve/dealias.h"
#include "stormcellar/retrieve/hail.h"
#include "stormcellar/retrieve/storm_motion.h"

namespace stormcellar::retrieve {

// The source of the motion for SRV: for all but `given`, the volume's own wind profile
// (bunkers_motions()).
enum class MotionRule : std::uint8_t { right, left, mean, given };

struct MotionChoice {
    MotionRule rule = MotionRule::right;
    Motion motion = {};  // for `given`
};

// The default of options, which is the same as "right".
inline constexpr std::string_view automatic_motion = "auto";

// Reads auto, right, left, mean, or a motion such as 240/15. Errors: bad_argument, with these
// words.
[[nodiscard]] Result<MotionChoice> motion_choice_from(std::string_view text);
// Returns "auto, right, left, mean, or a motion such as 240/15, from 240 degrees at 15 m/s".
[[nodiscard]] std::string motion_choices();
// Returns a text that motion_choice_from() reads as the same choice.
[[nodiscard]] std::string motion_choice_text(const MotionChoice& choice);

struct DerivedOptions {
    Dealiasing dealiasing = Dealiasing::automatic;
    MotionChoice motion = {};  // for SRV
    // Gates with a smaller probability of weather (quality.h) first become below threshold, and a
    // note gives their share (quality_in_notes()). 0: no gate is left out.
    double quality = 0;
    // Height of 0 C above sea level that HCA assumes if a volume shows no melting layer.
    double zero_c_m = FreezingLevels{}.zero_c_m;
};

// Returns true if a volume must pass through add_derived_moments() before its use.
[[nodiscard]] bool must_derive(std::span<const level2::Moment> wanted,
                               const DerivedOptions& options);

struct Derived {
    Dealiased dealiased;
    // Remarks for the provenance of grids: the motion of SRV (motion_in_notes()), and how the
    // velocities of AZSH and DIVG were dealiased (dealiasing_in_notes()).
    std::vector<std::string> notes;
};

// Adds the wanted moments, and VELD after each velocity moment if another moment comes from it.
// Replaces derived moments that the volume has. Errors: see above.
[[nodiscard]] Result<Derived> add_derived_moments(level2::Volume& volume,
                                                  std::span<const level2::Moment> wanted,
                                                  const DerivedOptions& options = {});

struct DerivedVolume {
    level2::Volume volume;
    std::vector<std::string> notes;
};

// Returns a copy of the volume with the wanted moments. Unless POW, KDP, RATE or HCA is wanted, or
// options.quality is given, the copy has only velocities and the moments derived from them. Errors:
// see above.
[[nodiscard]] Result<DerivedVolume> derived_velocities(const level2::Volume& volume,
                                                       std::span<const level2::Moment> wanted,
                                                       const DerivedOptions& options = {});

// Returns a copy of a sweep with only its velocities, VELD, and AZSH and DIVG if they are wanted.
// `known` is as in dealias().
[[nodiscard]] level2::Sweep dealiased_sweep(const level2::Sweep& sweep, Dealiasing rung,
                                            std::span<const level2::Sweep> known,
                                            std::span<const level2::Moment> wanted = {});

// Adds SRV, AZSH or DIVG to a volume that has VELD, as add_derived_moments() does, and returns the
// notes. Does nothing for VELD, and keeps AZSH and DIVG if all sweeps with VELD have them. Errors:
// not_found if SRV is wanted and the wind profile gives no motion.
[[nodiscard]] Result<std::vector<std::string>> add_from_dealiased(level2::Volume& volume,
                                                                  level2::Moment wanted,
                                                                  const DerivedOptions& options);

// Returns the storm motion that notes of a grid's provenance give. Returns none if no note gives a
// motion, or if the sites of a mosaic have different motions.
[[nodiscard]] std::optional<Motion> motion_in_notes(std::span<const std::string> notes);
// Returns true if all motions in the notes come from this choice. Notes without a motion give true.
[[nodiscard]] bool is_of_motion(std::span<const std::string> notes, const MotionChoice& choice);
// Returns the name of the rung in the same way; empty if there is none.
[[nodiscard]] std::string dealiasing_in_notes(std::span<const std::string> notes);

// Returns the remark of a grid's provenance on gates that were left out as probably no weather,
// with the two most frequent kinds of their echo (echo_kinds.h): "probability of weather at least
// 0.5; 12.3 % of the echo left out: birds and insects 8.1 %, ground clutter 3.0 %". If the sites of
// a mosaic differ, the remark gives the range of their shares, "43 to 98 %", and no kinds. The
// remark has no share if the share is unknown. Returns an empty text if no note has such a remark.
[[nodiscard]] std::string quality_in_notes(std::span<const std::string> notes);

}  // namespace stormcellar::retrieve
