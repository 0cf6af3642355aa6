// grid/polar_sweep.h -- one sweep of a moment, made ready to be sampled at many columns.
//
// What depends on the arc alone (the gate's number, the beam's height) stands in tables of arc, 500
// m apart, and is linear between: off by less than 0.15 m in range and height within 500 km
// (enforced by tests/grid/polar_sweep_test.cpp).
// Refers to the volume, which must outlive it. Immutable; use it from many threads.
#pragma once

#include <cstdint>
#include <vector>

#include "grid/azimuth_table.h"
#include "grid/beam_geometry.h"
#include "grid/column_geometry.h"
#include "grid/grid.h"
#include "grid/sweep_choice.h"
#include "level2/volume.h"

namespace stormcellar::grid {

// What a sweep holds at a column.
struct Sample {
    CellStatus status = CellStatus::not_seen;
    float value = 0;      // where the status is value
    float limit_dbz = 0;  // where the status is no_echo: what the gate could have seen
};

// Where along the tables a column lies.
struct ArcPlace {
    std::size_t index = 0;
    float fraction = 0;
};

class ArcTable {
  public:
    static constexpr double step_m = 500;

    ArcTable() = default;
    // `at` gives the value for an arc in metres.
    template <class Function>
    ArcTable(std::size_t size, Function at) {
        values_.reserve(size);
        for (std::size_t i = 0; i < size; ++i)
            values_.push_back(static_cast<float>(at(step_m * static_cast<double>(i))));
    }
    [[nodiscard]] float at(ArcPlace place) const {
        const float here = values_[place.index];
        return here + place.fraction * (values_[place.index + 1] - here);
    }

  private:
    std::vector<float> values_;
};

struct PolarSweepOptions {
    level2::Moment moment = level2::Moment::ref;
    double half_beam_deg = 0.475;
    bool is_tdwr = false;
    std::size_t table_size = 2;  // arcs from 0 to (table_size - 1) * step_m
};

class PolarSweep {
  public:
    PolarSweep(const level2::Sweep& sweep, const ChosenSweep& chosen, const BeamGeometry& beam,
               const PolarSweepOptions& options);

    [[nodiscard]] Sample sample(float azimuth_deg, ArcPlace place) const;
    [[nodiscard]] float beam_height_m(ArcPlace place) const { return height_.at(place); }
    // Of the beam's lower and upper edge, half a beam width off its centre.
    [[nodiscard]] float lower_edge_m(ArcPlace place) const { return lower_edge_.at(place); }
    [[nodiscard]] float upper_edge_m(ArcPlace place) const { return upper_edge_.at(place); }

  private:
    // The radials of a sweep that share gate geometry and coding.
    struct Kind {
        const level2::SweepMoment* moment = nullptr;
        ArcTable gate;                    // gate number plus one half: its floor is the nearest
        float first_gate = 0;             // the first that is not at negative range
        std::vector<float> values;        // by code, for 8-bit codes
        std::vector<float> spreading_db;  // by gate: 20 log10 of the range in km
    };
    struct Row {
        std::uint32_t kind = 0;
        std::uint32_t radial = 0;
        std::int32_t gate_count = 0;
        float limit_at_1km_dbz = 0;
        float attenuation_db_per_m = 0;
    };

    void add_rows(const level2::Sweep& sweep, const ChosenSweep& chosen,
                  const PolarSweepOptions& options);

    ArcTable height_, lower_edge_, upper_edge_;
    std::vector<Kind> kinds_;
    std::vector<Row> rows_;
    AzimuthTable azimuths_;  // positions in rows_
};

// The greatest arc that any used gate of the sweep lies at.
[[nodiscard]] double greatest_arc_m(const level2::Sweep& sweep, const ChosenSweep& chosen,
                                    level2::Moment moment, const BeamGeometry& beam);

}  // namespace stormcellar::grid
