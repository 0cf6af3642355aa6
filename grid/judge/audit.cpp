#include "grid/judge/audit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/degree.h"
#include "base/parallel.h"
#include "grid/beam/detection_limit.h"
#include "grid/beam/gate_places.h"
#include "grid/cells/moment_rules.h"
#include "grid/place/site_columns.h"
#include "grid/sweep/mixture.h"
#include "grid/sweep/sweep_stack.h"
#include "stormcellar/grid/beam_model.h"
#include "stormcellar/grid/grid_sampler.h"

namespace stormcellar::grid {
namespace {

constexpr std::size_t classes = audit_range_borders_m.size() + 1;

// Returns the state that a cell has if it is like the gate. Returns none for a gate with no data,
// which says nothing about the weather.
std::optional<CellStatus> status_of(level2::GateStatus status) {
    switch (status) {
        case level2::GateStatus::valid:
            return CellStatus::value;
        case level2::GateStatus::below_threshold:
            return CellStatus::no_echo;
        case level2::GateStatus::range_folded:
            return CellStatus::range_folded;
        case level2::GateStatus::ambiguous:
            return CellStatus::ambiguous;
        case level2::GateStatus::no_data:
            break;
    }
    return std::nullopt;
}

float shorter_way(float difference, float period) {
    return period > 0 ? std::remainder(difference, period) : difference;
}

// The status of the grid at a gate, and the difference between the grid and the gate.
struct Finding {
    CellStatus status = CellStatus::not_seen;
    float difference = 0;  // grid minus gate; 0 unless both have a value
};

// The facts about a gate that mix() needs.
struct Gate {
    float value = 0;
    float period = 0;
    // The detection limit, which is the value of a gate without echo in a mean. NaN: such a gate
    // does not enter the mean.
    float limit = std::numeric_limits<float>::quiet_NaN();
};

// Applies the status rule to the eight cells around a gate.
Finding mix(const GridSampler::Corners& corners, const Gate& gate) {
    std::array<float, cell_status_count> weights{};
    float sum = 0;
    for (const GridSampler::Corner& corner : corners) {
        weights[static_cast<std::size_t>(corner.status)] += corner.weight;
        if (corner.status == CellStatus::value) {
            sum += corner.weight * shorter_way(corner.value - gate.value, gate.period);
        }
    }
    const float unseen = weights[static_cast<std::size_t>(CellStatus::not_seen)];
    const float quiet = weights[static_cast<std::size_t>(CellStatus::no_echo)];
    const float folded = weights[static_cast<std::size_t>(CellStatus::range_folded)];
    const float ambiguous = weights[static_cast<std::size_t>(CellStatus::ambiguous)];
    float valued = weights[static_cast<std::size_t>(CellStatus::value)];
    if (unseen > 0.5F) return {CellStatus::not_seen};
    if (folded + ambiguous > valued && folded + ambiguous > quiet)
        return {folded >= ambiguous ? CellStatus::range_folded : CellStatus::ambiguous};
    if (valued < quiet) return {CellStatus::no_echo};
    if (quiet > 0 && !std::isnan(gate.limit)) {
        sum += quiet * (gate.limit - gate.value);
        valued += quiet;
    }
    return {CellStatus::value, sum / valued};
}

// The sums for one sweep and one class of ranges.
struct Sums {
    std::uint32_t sampled = 0, same_status = 0, count = 0;
    double sum = 0, squares = 0;
};

struct SweepAudit {
    std::array<Sums, classes> ranges{};
    decltype(Audit::states) states{};
};

std::size_t class_of(double range_m) {
    const auto* const end =
        std::upper_bound(audit_range_borders_m.begin(), audit_range_borders_m.end(), range_m);
    return static_cast<std::size_t>(end - audit_range_borders_m.begin());
}

// The data that all sweeps of an audit share.
struct Scan {
    const level2::Volume& volume;
    const GridSampler& sampler;
    const SiteColumns& columns;
    const BeamModel& beam;
    const AuditOptions& options;
    level2::Moment moment = level2::Moment::ref;
    double half_beam_deg = 0;
    bool is_tdwr = false;
};

// Audits the radials of one kind in a sweep. Takes only some of their gates.
class KindScan {
  public:
    KindScan(const Scan& scan, const level2::Sweep& sweep, const level2::SweepMoment& moment,
             double elevation_deg)
        : scan_(scan),
          sweep_(sweep),
          moment_(moment),
          elevation_deg_(elevation_deg),
          gate_step_(std::max(
              1, static_cast<int>(std::lround(scan.options.range_step_m / moment.gate_spacing_m)))),
          places_(thinned(moment, gate_step_), scan.beam, elevation_deg, scan.half_beam_deg) {}

    void add(std::size_t radial, SweepAudit& found) const {
        const level2::Radial& pointing = sweep_.radials[radial];
        const double azimuth = static_cast<double>(pointing.azimuth_deg) * degree;
        const double sine = std::sin(azimuth);
        const double cosine = std::cos(azimuth);
        const double offset_deg = static_cast<double>(pointing.elevation_deg) - elevation_deg_;
        const DetectionLimit limit = detection_limit(pointing, moment_, scan_.is_tdwr);
        Gate gate{.period = 2 * half_period_of(scan_.moment, pointing.nyquist_mps)};
        GridSampler::Corners corners;
        for (std::int32_t number = 0; number < moment_.gate_counts[radial]; number += gate_step_) {
            const double range_m = moment_.range_m(number);
            if (range_m < 0) continue;
            if (range_m > audit_reach_m) break;
            const auto status = status_of(moment_.status(radial, number));
            if (!status) continue;
            const auto place = places_.at(number / gate_step_, offset_deg);
            if (!place || place->arc_m > audit_reach_m) continue;
            const double level = scan_.sampler.level_at(place->height_m);
            if (!scan_.sampler.find(scan_.columns.at(sine, cosine, place->arc_m), level, corners)) {
                continue;
            }
            gate.value = moment_.value_of(moment_.code(radial, number));
            if (rules_of(scan_.moment).has_detection_limit && needs_limit(corners)) {
                gate.limit = static_cast<float>(limit.at(range_m));
            }
            count(range_m, *status, mix(corners, gate), found);
        }
    }

  private:
    // Returns a moment that has only the sampled gates. The result is used only to compute the
    // places of these gates.
    static level2::SweepMoment thinned(const level2::SweepMoment& moment, int gate_step) {
        level2::SweepMoment few;
        few.first_gate_m = moment.first_gate_m;
        few.gate_spacing_m = moment.gate_spacing_m * gate_step;
        few.gate_stride = (moment.gate_stride + gate_step - 1) / gate_step;
        return few;
    }
    // Returns true if some corners have a value and some have no echo.
    static bool needs_limit(const GridSampler::Corners& corners) {
        bool echo = false;
        bool none = false;
        for (const GridSampler::Corner& corner : corners) {
            echo = echo || corner.status == CellStatus::value;
            none = none || corner.status == CellStatus::no_echo;
        }
        return echo && none;
    }
    static void count(double range_m, CellStatus status, const Finding& finding,
                      SweepAudit& found) {
        Sums& sums = found.ranges[class_of(range_m)];
        ++sums.sampled;
        ++found.states[static_cast<std::size_t>(status)][static_cast<std::size_t>(finding.status)];
        if (status != finding.status) return;
        ++sums.same_status;
        if (status != CellStatus::value) return;
        ++sums.count;
        const auto difference = static_cast<double>(finding.difference);
        sums.sum += difference;
        sums.squares += difference * difference;
    }

    const Scan& scan_;
    const level2::Sweep& sweep_;
    const level2::SweepMoment& moment_;
    double elevation_deg_;
    std::int32_t gate_step_;
    GatePlaces places_;
};

SweepAudit scan_sweep(const Scan& scan, const ChosenSweep& chosen) {
    SweepAudit found;
    const level2::Sweep& sweep = scan.volume.sweeps[chosen.sweep_index];
    const auto radials = static_cast<double>(chosen.radials.size());
    const auto step = static_cast<std::size_t>(
        std::max(1L, std::lround(std::min(scan.options.azimuth_step_deg / 360, 1.0) * radials)));
    for (const level2::SweepMoment& moment : sweep.moments) {
        if (moment.moment != scan.moment || moment.gate_spacing_m <= 0) continue;
        const KindScan kind(scan, sweep, moment, chosen.elevation_deg);
        for (std::size_t i = 0; i < chosen.radials.size(); i += step) {
            const std::size_t radial = chosen.radials[i];
            if (radial < moment.gate_counts.size()) kind.add(radial, found);
        }
    }
    return found;
}

void append_rows(const SweepAudit& sweep, double elevation_deg, std::vector<AuditRow>& rows) {
    for (std::size_t i = 0; i < classes; ++i) {
        const Sums& sums = sweep.ranges[i];
        if (sums.sampled == 0) continue;
        AuditRow row;
        row.elevation_deg = static_cast<float>(elevation_deg);
        row.range_from_m = i == 0 ? 0 : static_cast<float>(audit_range_borders_m[i - 1]);
        row.range_to_m = i + 1 < classes ? static_cast<float>(audit_range_borders_m[i])
                                         : std::numeric_limits<float>::infinity();
        row.sampled = sums.sampled;
        row.same_status = sums.same_status;
        row.count = sums.count;
        if (sums.count > 0) {
            row.rms = static_cast<float>(std::sqrt(sums.squares / sums.count));
            row.mean = static_cast<float>(sums.sum / sums.count);
        }
        rows.push_back(row);
    }
}

}  // namespace

Result<Audit> audit(const BrickView& grid, const level2::Volume& volume, const SitePosition& site,
                    const GridderOptions& gridded, const AuditOptions& options) {
    if (!std::isgreater(options.azimuth_step_deg, 0.0) ||
        !std::isgreater(options.range_step_m, 0.0) || options.threads < 1) {
        return fail(ErrorCode::bad_argument,
                    "an audit needs steps and threads, not {} degrees, {} m and {} threads",
                    options.azimuth_step_deg, options.range_step_m, options.threads);
    }
    const std::vector<ChosenSweep> chosen = sweeps_to_grid(volume, site, gridded);
    if (chosen.empty()) {
        return fail(ErrorCode::not_found, "the volume has no sweep with {}",
                    level2::moment_name(gridded.moment));
    }
    const double beam_width_deg =
        gridded.beam_width_deg > 0 ? gridded.beam_width_deg : beam_width_of(site.icao);
    const GridSampler sampler(grid);
    std::optional<SiteColumns> made_here;
    if (options.columns == nullptr) made_here.emplace(site, *grid.spec, audit_reach_m);
    const SiteColumns& columns = made_here ? *made_here : *options.columns;
    const BeamModel beam = beam_model_of(site, gridded.method.beam, gridded.profile);
    const Scan scan{volume,
                    sampler,
                    columns,
                    beam,
                    options,
                    gridded.moment,
                    beam_width_deg / 2,
                    is_tdwr(site.icao)};
    std::vector<SweepAudit> sweeps(chosen.size());
    for_each_piece(static_cast<int>(chosen.size()), options.threads, [&](int piece) {
        const auto i = static_cast<std::size_t>(piece);
        sweeps[i] = scan_sweep(scan, chosen[i]);
    });
    Audit made;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        append_rows(sweeps[i], chosen[i].elevation_deg, made.rows);
        for (std::size_t gate = 0; gate < made.states.size(); ++gate) {
            for (std::size_t cell = 0; cell < made.states.size(); ++cell)
                made.states[gate][cell] += sweeps[i].states[gate][cell];
        }
    }
    return made;
}

}  // namespace stormcellar::grid
