// retrieve/quality/echo_features.h -- features of each gate that tell weather from other echo.
//
// Threads   Pure functions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "retrieve/quality/gate_field.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/retrieve/quality.h"

namespace stormcellar::retrieve {

// Boxes are radials x range. Textures are root mean squares of differences between neighbors.
enum class Feature : std::uint8_t {
    reflectivity,        // dBZ, of the gate
    height,              // m above the antenna
    range_texture,       // dB, of reflectivity along the radial, 3 x 1.75 km
    azimuth_texture,     // dB, of reflectivity across radials, 3 x 1.75 km
    echo_share,          // share of gates with echo, 9 x 8.25 km
    mean_reflectivity,   // dBZ, 9 x 8.25 km
    reflectivity_above,  // dBZ, mean of 3 x 1.25 km in the next sweep above
    speed,               // m/s, of the gate, without its sign, not dealiased
    speed_texture,       // m/s, along the radial, 3 x 1.75 km
    width,               // m/s, mean of the spectrum width, 3 x 1.75 km
    speed_share,         // share of gates with a velocity, 3 x 1.75 km
    correlation,         // mean of the correlation coefficient, 3 x 1.25 km
    zdr_texture,         // dB, along the radial, 3 x 2.25 km
    phase_texture,       // degrees, along the radial, 3 x 2.25 km
};
inline constexpr auto feature_count = static_cast<std::size_t>(Feature::phase_texture) + 1;

[[nodiscard]] std::string_view feature_name(Feature feature);

// The gates of a field that have echo, or some of these gates.
class EchoGates {
  public:
    explicit EchoGates(const GateField& field);
    // Has only gates whose probability of weather is below `least`.
    EchoGates(const GateField& field, std::span<const float> probabilities, float least);

    // Returns the gates of a radial, in order.
    [[nodiscard]] std::span<const std::uint32_t> of(std::size_t radial) const {
        return std::span(gates_).subspan(begins_[radial], begins_[radial + 1] - begins_[radial]);
    }
    // Returns how many of these gates come before the radial.
    [[nodiscard]] std::size_t begin(std::size_t radial) const { return begins_[radial]; }
    [[nodiscard]] std::size_t count() const { return gates_.size(); }

  private:
    template <class IsTaken>
    void take(const GateField& field, IsTaken is_taken);

    std::vector<std::uint32_t> gates_;
    std::vector<std::size_t> begins_;
};

// Is called with the values of a feature at the gates with echo of a radial; NaN where the value is
// missing. It is called once for each radial, in any order.
using FeatureVisitor =
    std::function<void(Feature feature, std::size_t radial, std::span<const float> values)>;

// Visits the features of a rule. For each radial they come in a fixed order, which is not that of
// Feature. `field` is a reflectivity moment of the sweep, and `echo` has its gates. Doppler
// features come from the sweep itself or from the sweep of nearest elevation, at most 0.3 degrees
// away; they are missing if there is no such sweep. Other moments are read into `scratch`, whose
// memory serves all sweeps.
void visit_features(const level2::Volume& volume, std::size_t sweep, const GateField& field,
                    const EchoGates& echo, QualityRule rule, GateField& scratch,
                    const FeatureVisitor& visit);

// Visits, in the same way, the features that decide the kind of echo that is not weather
// (stormcellar/retrieve/echo_kinds.h): reflectivity, height, range_texture, echo_share,
// reflectivity_above and the Doppler features, and for the dual rule correlation and phase_texture.
void visit_kind_features(const level2::Volume& volume, std::size_t sweep, const GateField& field,
                         const EchoGates& echo, QualityRule rule, GateField& scratch,
                         const FeatureVisitor& visit);

}  // namespace stormcellar::retrieve
