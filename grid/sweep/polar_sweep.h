// grid/sweep/polar_sweep.h -- one sweep of a moment, prepared for being sampled at many columns.
//
// What depends on the arc alone (the number of the gate, the height of the beam) is in tables with
// a step of 500 m along the arc, and linear in between.
//
// A radial that was measured higher or lower than its sweep has its beam on the parabola through
// the beam's center and edges; its gates are those of the sweep's elevation. An edge of the beam is
// lost if it never passes over an arc, or if it passes on the other side of the beam's center;
// ducts and the ground do that. A missing edge is mirrored from the other edge; if both are
// missing, half the beam width at the range of the center replaces them. So the rise for each
// degree is that of the half that exists. Nothing is seen between the center and a lost edge.
//
// Units     Values are in the unit of the moment, or in mm^6/m^3 (Averaging::in_z, reflectivity
//           only).
// Threads   Immutable; many threads may use one object. It refers to the volume, which must outlive
//           it.
// Accuracy  Enforced by tests/grid/polar_sweep_test.cpp for elevations of -5 to 60 degrees. tables
//           0.15 m in range and height within 500 km, for the 4/3 earth and for rays through
//                    the reference atmosphere (kinked profiles: stormcellar/grid/beam_model.h)
//           radials  up to half a beam off: the center within 0.25 m of the 4/3 earth, the edges
//                    within 1 m, for beams of 0.95 degrees within 470 km and below 21 km
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "grid/beam/arc_table.h"
#include "grid/sweep/azimuth_table.h"
#include "grid/sweep/busy_blocks.h"
#include "grid/sweep/mixture.h"
#include "stormcellar/grid/beam_model.h"
#include "stormcellar/grid/method.h"
#include "stormcellar/grid/sweep_choice.h"
#include "stormcellar/grid/tile.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::grid {

struct PolarSweepOptions {
    level2::Moment moment = level2::Moment::ref;
    double half_beam_deg = 0.475;
    bool is_tdwr = false;
    std::size_t table_size = 2;  // arcs from 0 to (table_size - 1) * ArcTable::step_m
    ChosenAveraging averaging = {};
    ChosenCircle on_circle = {};
    ChosenExtent cell = {};
};

// Where the center of a beam never passes over an arc, the beam counts as higher than this.
inline constexpr float highest_beam_m = 1e8F;

class PolarSweep {
  public:
    PolarSweep(const level2::Sweep& sweep, const ChosenSweep& chosen, const BeamModel& beam,
               const PolarSweepOptions& options);

    // The heights of the beam's center and of its edges, half a beam width off, lost edges
    // included.
    struct BeamHeights {
        float center_m = 0, lower_m = 0, upper_m = 0;
    };
    // What the tables hold for an arc.
    struct BeamAtArc {
        BeamHeights heights;
        float gate_and_half = 0;  // GatePlace::number_and_half for the first kind of radials
    };
    [[nodiscard]] BeamAtArc beam_at(ArcPlace place) const {
        const Lanes& here = beam_[place.index];
        const Lanes& next = beam_[place.index + 1];
        Lanes at;
        for (std::size_t i = 0; i < at.size(); ++i)
            at[i] = here[i] + place.fraction * (next[i] - here[i]);
        return {{at[0], at[1], at[2]}, at[3]};
    }
    [[nodiscard]] BeamHeights heights(ArcPlace place) const { return beam_at(place).heights; }
    // The same for a beam that is higher than the sweep's elevation by `offset_deg`.
    [[nodiscard]] BeamHeights heights(ArcPlace place, float offset_deg) const {
        return offset(heights(place), offset_deg);
    }
    [[nodiscard]] BeamHeights offset(const BeamHeights& sweep, float offset_deg) const {
        const float linear_m = (sweep.upper_m - sweep.lower_m) / 2;
        const float square_m = (sweep.upper_m + sweep.lower_m) / 2 - sweep.center_m;
        const auto at = [&](float halves) {
            return sweep.center_m + halves * (linear_m + halves * square_m);
        };
        const float halves = offset_deg * halves_per_deg_;
        return {at(halves), at(halves - 1), at(halves + 1)};
    }
    // Of the beam of the radial at that position; of the sweep's elevation where it is none.
    [[nodiscard]] BeamHeights heights_at(int position, ArcPlace place) const {
        const BeamHeights sweep = heights(place);
        return position == AzimuthTable::none ? sweep
                                              : offset(sweep, elevation_offset_deg(position));
    }
    [[nodiscard]] float rise_m_per_deg(const BeamHeights& heights) const {
        return (heights.upper_m - heights.lower_m) / 2 * halves_per_deg_;
    }
    // Returns the part of the beam that is seen: lost edges are moved to the center.
    [[nodiscard]] BeamHeights without_lost_edges(ArcPlace place, BeamHeights heights) const {
        if (lost_edges_.empty()) return heights;
        const unsigned lost = lost_edges_[place.index] | lost_edges_[place.index + 1];
        if ((lost & lost_lower) != 0) heights.lower_m = heights.center_m;
        if ((lost & lost_upper) != 0) heights.upper_m = heights.center_m;
        return heights;
    }
    // Returns the position of the nearest radial among the radials used, or AzimuthTable::none.
    [[nodiscard]] int radial_at(float azimuth_deg) const { return azimuths_.find(azimuth_deg); }
    // Returns the nearest gate of the radial at that position.
    [[nodiscard]] Sample sample(int position, ArcPlace place) const {
        return sample(position, place, beam_at(place));
    }
    [[nodiscard]] Sample sample(float azimuth_deg, ArcPlace place) const {
        return sample(radial_at(azimuth_deg), place);
    }
    // The same, for callers that have beam_at(place) already.
    [[nodiscard]] Sample sample(int position, ArcPlace place, const BeamAtArc& beam) const;
    // Adds two gates of that radial, linear in range. Half a gate beyond the first and the last
    // gate, that gate alone counts.
    void add_along_radial(int position, ArcPlace place, float weight, Mixture& mixture) const;
    // The gate of a radial as a number, which is a whole number and a half at the centers of gates.
    struct GatePlace {
        float number_and_half = 0;  // its floor is the nearest gate
        std::int32_t first = 0;     // the first gate that is not at negative range
        std::int32_t end = 0;
    };
    [[nodiscard]] GatePlace gate_place(int position, ArcPlace place) const;
    // Returns how many gates the beam passes for each meter of arc; 0 where the beam does not pass
    // any farther. All radials of one kind share it. If there are several kinds, the result is that
    // of the first.
    [[nodiscard]] float gates_per_m_of_arc(ArcPlace place) const;
    // Returns a gate within the range of GatePlace.
    [[nodiscard]] Sample gate(int position, std::int32_t gate) const;
    // Adds all gates from `first` to before `end`, each with weight 1. The gates must be within
    // that range. Adds none if `end` is not above `first`.
    void add_gates(int position, std::int32_t first, std::int32_t end, Mixture& mixture) const;

    // Returns how much higher the radial was measured than the sweep's elevation.
    [[nodiscard]] float elevation_offset_deg(int position) const {
        return rows_[static_cast<std::size_t>(position)].elevation_offset_deg;
    }
    [[nodiscard]] const AzimuthTable& azimuths() const { return azimuths_; }
    [[nodiscard]] Blending blending() const { return blending_; }
    [[nodiscard]] std::size_t radial_count() const { return rows_.size(); }
    // Returns the index in Sweep::radials.
    [[nodiscard]] std::uint32_t radial_index(int position) const {
        return rows_[static_cast<std::size_t>(position)].radial;
    }

    // Returns the gates of the radial; null if it has none of the moment.
    [[nodiscard]] const level2::SweepMoment* moment_of(int position) const {
        const Row& row = rows_[static_cast<std::size_t>(position)];
        return row.gate_count > 0 ? kinds_[row.kind].moment : nullptr;
    }

    // Returns the status that every sample within the bounds has, if they are all no echo or all
    // not seen. This also holds for mixtures, which take in one more gate and one more radial.
    // Returns none if the samples may differ.
    [[nodiscard]] std::optional<CellStatus> uniform_status(const PolarBounds& bounds) const;

  private:
    // A BeamAtArc in the order of its members. The compiler turns it into one vector.
    using Lanes = std::array<float, 4>;
    static constexpr std::uint8_t lost_lower = 1, lost_upper = 2;
    // The radials of a sweep that share gate geometry and coding.
    struct Kind {
        const level2::SweepMoment* moment = nullptr;
        ArcTable gate;  // gate number plus one half, so that its floor is the nearest gate
        std::int32_t first_gate = 0;  // the first that is not at negative range
        std::uint16_t first_valid_code = 2;
        std::vector<float> values;  // by code, for 8-bit codes
        // By gate, for moments with a detection limit: what the range adds to the limit in dB, or
        // the factor by which it multiplies the limit in Z.
        struct Loss {
            float spreading;    // 20 log10 of the range in km, or its power
            float attenuation;  // for radials whose attenuation_db_per_m is that of the kind
        };
        std::vector<Loss> losses;
        // sums of both over all earlier gates; only for cells with an extent
        std::vector<double> loss_sums;
        float attenuation_db_per_m = 0;
    };
    struct Row {
        // the codes of this radial if they have 8 bits, else null
        const std::uint8_t* codes8 = nullptr;
        std::uint32_t kind = 0;
        std::uint32_t radial = 0;
        std::int32_t gate_count = 0;
        float limit_at_1km = 0;  // dBZ, or a factor
        float attenuation_db_per_m = 0;
        float half_period = 0;
        float elevation_offset_deg = 0;
        // detection limits are in dB, and the losses of the kind apply
        bool has_simple_limit = false;
    };

    void add_kind(const level2::SweepMoment& moment, const BeamPath& path, std::size_t table_size);
    void add_losses(float attenuation_db_per_m, Kind& kind) const;
    void make_beam_table(double elevation_deg, const BeamModel& beam,
                         const PolarSweepOptions& options);
    void add_rows(const level2::Sweep& sweep, const ChosenSweep& chosen,
                  const PolarSweepOptions& options);
    void mark_blocks();
    [[nodiscard]] Sample gate_of(const Row& row, const Kind& kind, std::int32_t gate) const;
    [[nodiscard]] Sample wide_gate_of(const Row& row, const Kind& kind, std::int32_t gate) const;
    [[nodiscard]] Sample without_value(const Row& row, const Kind& kind, std::int32_t gate,
                                       std::uint16_t code) const;
    // These gates are values, no echo or range folded, and have simple limits if they have limits.
    template <class CodeAt, class ValueOf>
    void add_plain_gates(const Row& row, const Kind& kind, std::int32_t first, std::int32_t end,
                         const CodeAt& code_at, const ValueOf& value_of, Mixture& mixture) const;
    [[nodiscard]] float detection_limit_of(const Row& row, const Kind& kind,
                                           std::int32_t gate) const;

    Blending blending_;
    ChosenAveraging averaging_;
    ChosenExtent cell_;
    float halves_per_deg_;                  // half beam widths in a degree
    std::vector<Lanes> beam_;               // by arc, like an ArcTable
    std::vector<std::uint8_t> lost_edges_;  // by arc; empty if no edge is lost
    std::vector<Kind> kinds_;
    std::vector<Row> rows_;
    AzimuthTable azimuths_;  // positions in rows_
    BusyBlocks busy_;        // only for 8-bit codes of one kind whose code 0 is no echo
    std::int32_t fewest_gates_ = 0, most_gates_ = 0;  // of any row
};

inline Sample PolarSweep::gate_of(const Row& row, const Kind& kind, std::int32_t gate) const {
    if (row.codes8 == nullptr) return wide_gate_of(row, kind, gate);
    const std::uint8_t code = row.codes8[gate];
    if (code >= kind.first_valid_code) {
        return {CellStatus::value, kind.values[code], 0, row.half_period};
    }
    if (code == 0 && row.has_simple_limit) {
        const Kind::Loss& loss = kind.losses[static_cast<std::size_t>(gate)];
        return {CellStatus::no_echo, 0, row.limit_at_1km + loss.spreading + loss.attenuation, 0};
    }
    return without_value(row, kind, gate, code);
}

inline Sample PolarSweep::sample(int position, ArcPlace place, const BeamAtArc& beam) const {
    if (position == AzimuthTable::none) return {};
    const Row& row = rows_[static_cast<std::size_t>(position)];
    if (row.gate_count == 0) return {};
    const Kind& kind = kinds_[row.kind];
    const float gate_and_half = row.kind == 0 ? beam.gate_and_half : kind.gate.at(place);
    const bool within = gate_and_half >= static_cast<float>(kind.first_gate) &&
                        gate_and_half < static_cast<float>(row.gate_count);
    if (!within) return {};
    return gate_of(row, kind, static_cast<std::int32_t>(gate_and_half));
}

// Returns the greatest arc of any used gate of the sweep.
[[nodiscard]] double greatest_arc_m(const level2::Sweep& sweep, const ChosenSweep& chosen,
                                    level2::Moment moment, const BeamModel& beam);

}  // namespace stormcellar::grid
