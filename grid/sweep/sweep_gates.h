// grid/sweep/sweep_gates.h -- the gates of one sweep of a moment, prepared to be read at arcs.
//
// A "position" is the number of a used radial, in the order of ChosenSweep::radials.
//
// Units     Values are in the unit of the moment, or in mm^6/m^3 (Averaging::in_z, reflectivity
//           only).
// Threads   Immutable; many threads may use one object. The volume must outlive it.
// Accuracy  grid/sweep/polar_sweep.h states it.
#pragma once

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

class SweepGates {
  public:
    SweepGates(const level2::Sweep& sweep, const ChosenSweep& chosen, const BeamModel& beam,
               const PolarSweepOptions& options);

    // Returns the table of gate numbers plus one half, by arc, for radials of kind 0. Returns null
    // if the sweep has no gates of the moment.
    [[nodiscard]] const ArcTable* first_table() const {
        return kinds_.empty() ? nullptr : &kinds_[0].gate;
    }
    // Returns the nearest gate of the radial at `position`. `gate_and_half` must be the value of
    // first_table() at `place`.
    [[nodiscard]] Sample sample(int position, ArcPlace place, float gate_and_half) const;
    // Adds two gates of the radial, with weights linear in range. Within half a gate beyond the
    // first or the last gate, only that gate counts.
    void add_along_radial(int position, ArcPlace place, float weight, Mixture& mixture) const;
    // A place along a radial as a gate number, which is n + 1/2 at the center of gate n.
    struct GatePlace {
        float number_and_half = 0;  // its floor is the nearest gate
        std::int32_t first = 0;     // the first gate at a range of 0 or more
        std::int32_t end = 0;
    };
    [[nodiscard]] GatePlace gate_place(int position, ArcPlace place) const;
    // Returns how many gates the beam passes in a meter of arc; 0 beyond the end of the beam. If
    // radials differ in gate spacing, the result is for kind 0.
    [[nodiscard]] float gates_per_m_of_arc(ArcPlace place) const;
    // Returns a gate. Its number must be from GatePlace::first to before GatePlace::end.
    [[nodiscard]] Sample gate(int position, std::int32_t gate) const;
    // Adds the gates from `first` to before `end`, each with weight 1. Adds nothing if `end` is not
    // above `first`. The gates must exist, as for gate().
    void add_gates(int position, std::int32_t first, std::int32_t end, Mixture& mixture) const;

    // Returns the measured elevation of the radial minus the elevation of the sweep.
    [[nodiscard]] float elevation_offset_deg(int position) const {
        return rows_[static_cast<std::size_t>(position)].elevation_offset_deg;
    }
    [[nodiscard]] Blending blending() const { return blending_; }
    [[nodiscard]] std::size_t radial_count() const { return rows_.size(); }
    // Returns the index of the radial in Sweep::radials.
    [[nodiscard]] std::uint32_t radial_index(int position) const {
        return rows_[static_cast<std::size_t>(position)].radial;
    }

    // Returns the moment of the radial; null if the radial has no gates of the moment.
    [[nodiscard]] const level2::SweepMoment* moment_of(int position) const {
        const Row& row = rows_[static_cast<std::size_t>(position)];
        return row.gate_count > 0 ? kinds_[row.kind].moment : nullptr;
    }

    // Returns the status of all gates of these radials between two arcs, and of one more gate on
    // each side, if all are no echo or all are not seen; else returns none. visit_radials(visit)
    // must call visit(position) for each radial, and with AzimuthTable::none for a gap, until visit
    // returns false.
    template <class VisitRadials>
    [[nodiscard]] std::optional<CellStatus> uniform_status(float least_arc_m, float greatest_arc_m,
                                                           const VisitRadials& visit_radials) const;

  private:
    // Radials of a sweep that have the same gate geometry and coding.
    struct Kind {
        const level2::SweepMoment* moment = nullptr;
        ArcTable gate;                // gate number plus one half; its floor is the nearest gate
        std::int32_t first_gate = 0;  // the first gate at a range of 0 or more
        std::uint16_t first_valid_code = 2;
        std::vector<float> values;  // by code; only for 8-bit codes
        // For each gate, if the moment has a detection limit: the dB that the gate's range adds to
        // the limit, or the factor by which it multiplies the limit in Z.
        struct Loss {
            float spreading;    // 20 log10 of the range in km, or the squared range for Z
            float attenuation;  // for radials with the kind's attenuation_db_per_m
        };
        std::vector<Loss> losses;
        // Sums of spreading + attenuation over all earlier gates; only for cells with an extent.
        std::vector<double> loss_sums;
        float attenuation_db_per_m = 0;
    };
    struct Row {
        // The codes of this radial if they have 8 bits, else null.
        const std::uint8_t* codes8 = nullptr;
        std::uint32_t kind = 0;
        std::uint32_t radial = 0;
        std::int32_t gate_count = 0;
        float limit_at_1km = 0;  // dBZ, or Z
        float attenuation_db_per_m = 0;
        float half_period = 0;
        float elevation_offset_deg = 0;
        // True if the limit is in dB and the radial's attenuation is the kind's, so that
        // Kind::losses apply.
        bool has_simple_limit = false;
    };

    // The blocks of gates between two arcs, or the status of all radials there.
    struct Between {
        std::optional<CellStatus> status;  // set if no radial has a gate there
        std::optional<BusyBlocks::Stretch> blocks;
    };
    [[nodiscard]] Between between(float least_arc_m, float greatest_arc_m) const;

    void add_kind(const level2::SweepMoment& moment, const BeamPath& path, std::size_t table_size);
    void add_losses(float attenuation_db_per_m, Kind& kind) const;
    void add_rows(const level2::Sweep& sweep, const ChosenSweep& chosen,
                  const PolarSweepOptions& options);
    void mark_blocks();
    [[nodiscard]] Sample gate_of(const Row& row, const Kind& kind, std::int32_t gate) const;
    [[nodiscard]] Sample wide_gate_of(const Row& row, const Kind& kind, std::int32_t gate) const;
    [[nodiscard]] Sample without_value(const Row& row, const Kind& kind, std::int32_t gate,
                                       std::uint16_t code) const;
    // Adds gates whose status is a value, no echo or range folded. Detection limits, if any, must
    // be simple (has_simple_limit).
    template <class CodeAt, class ValueOf>
    void add_plain_gates(const Row& row, const Kind& kind, std::int32_t first, std::int32_t end,
                         const CodeAt& code_at, const ValueOf& value_of, Mixture& mixture) const;
    [[nodiscard]] float detection_limit_of(const Row& row, const Kind& kind,
                                           std::int32_t gate) const;

    Blending blending_;
    ChosenAveraging averaging_;
    ChosenExtent cell_;
    std::vector<Kind> kinds_;
    std::vector<Row> rows_;
    BusyBlocks busy_;  // only for 8-bit codes of one kind whose code 0 is no echo
    std::int32_t fewest_gates_ = 0, most_gates_ = 0;  // of any row
};

inline Sample SweepGates::gate_of(const Row& row, const Kind& kind, std::int32_t gate) const {
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

inline Sample SweepGates::sample(int position, ArcPlace place, float gate_and_half) const {
    if (position == AzimuthTable::none) return {};
    const Row& row = rows_[static_cast<std::size_t>(position)];
    if (row.gate_count == 0) return {};
    const Kind& kind = kinds_[row.kind];
    const float here = row.kind == 0 ? gate_and_half : kind.gate.at(place);
    const bool within =
        here >= static_cast<float>(kind.first_gate) && here < static_cast<float>(row.gate_count);
    if (!within) return {};
    return gate_of(row, kind, static_cast<std::int32_t>(here));
}

template <class VisitRadials>
std::optional<CellStatus> SweepGates::uniform_status(float least_arc_m, float greatest_arc_m,
                                                     const VisitRadials& visit_radials) const {
    const Between found = between(least_arc_m, greatest_arc_m);
    if (!found.blocks) return found.status;
    bool quiet = true;
    visit_radials([&](int position) {
        quiet = position != AzimuthTable::none &&
                busy_.is_quiet(static_cast<std::size_t>(position), *found.blocks);
        return quiet;
    });
    if (quiet) return CellStatus::no_echo;
    return std::nullopt;
}

// Returns the greatest arc of any used gate of the sweep.
[[nodiscard]] double greatest_arc_m(const level2::Sweep& sweep, const ChosenSweep& chosen,
                                    level2::Moment moment, const BeamModel& beam);

}  // namespace stormcellar::grid
