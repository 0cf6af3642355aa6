#include "grid/fill/detail_filler.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "grid/beam/gate_places.h"
#include "grid/fill/mixed_column.h"
#include "grid/fill/tile_columns.h"
#include "grid/place/footprint.h"
#include "grid/sweep/sweep_mixture.h"

namespace stormcellar::grid {
namespace {

constexpr double degree = std::numbers::pi / 180;

// What is known of one sweep beside its gates.
struct SweepFacts {
    std::vector<std::optional<double>> ages_s;  // by position
    // Where the gates of each kind are; empty unless distances are asked for.
    std::vector<std::pair<const level2::SweepMoment*, GatePlaces>> places;
};

// The centre of a sweep's nearest gate as a column sees it.
struct NearGate {
    double height_m = 0;
    double across_map_m = 0;  // in the plane about the site
};

// One sweep over one column.
struct SeenBeam {
    float height_m = 0, lower_edge_m = 0, upper_edge_m = 0;
    bool adjacent_to_next = true;
    bool is_seen = false;
    std::optional<double> age_s;
    std::optional<NearGate> gate;
};

// Which sweeps make up a height; none: it is not seen.
struct Share {
    const SeenBeam* beam = nullptr;
    float weight = 0;
};
struct Shares {
    std::array<Share, 2> both;
    [[nodiscard]] float seen() const {
        float seen = 0;
        for (const auto& [beam, weight] : both)
            if (beam != nullptr && beam->is_seen) seen += weight;
        return seen;
    }
};

Shares alone(const SeenBeam& beam, float level_m) {
    if (!(level_m >= beam.lower_edge_m && level_m <= beam.upper_edge_m)) return {};
    return {{Share{&beam, 1}, Share{}}};
}

// Between sweeps with a lost cut between them: the nearer beam within whose edges the level lies.
Shares beside_a_gap(const SeenBeam& below, const SeenBeam& above, float level_m) {
    const bool below_is_nearer = level_m - below.height_m <= above.height_m - level_m;
    const Shares nearer = alone(below_is_nearer ? below : above, level_m);
    if (nearer.both[0].beam != nullptr) return nearer;
    return alone(below_is_nearer ? above : below, level_m);
}

// The same sweeps and weights as those of grid/fill/column.h. Heights rise; `above` is the first
// beam above the level, or the end.
Shares shares_at(std::span<const SeenBeam> beams, std::size_t above, float level_m, bool nearest) {
    if (beams.empty()) return {};
    if (above == 0) return alone(beams.front(), level_m);
    const SeenBeam& low = beams[above - 1];
    if (above == beams.size()) return alone(low, level_m);
    const SeenBeam& high = beams[above];
    if (!low.adjacent_to_next) return beside_a_gap(low, high, level_m);
    const float linear = (level_m - low.height_m) / (high.height_m - low.height_m);
    const float high_weight = !nearest ? linear : linear > 0.5F ? 1.0F : 0.0F;
    Shares shares;
    if (high_weight < 1) shares.both[0] = {&low, 1 - high_weight};
    if (high_weight > 0) shares.both[1] = {&high, high_weight};
    return shares;
}

std::vector<SweepFacts> facts_of(const DetailWork& work, std::optional<UtcTime> frame_time) {
    std::vector<SweepFacts> facts(work.chosen.size());
    const DetailSet asked = work.options.details;
    for (std::size_t at = 0; at < facts.size(); ++at) {
        const ChosenSweep& chosen = work.chosen[at];
        const level2::Sweep& sweep = work.volume.sweeps[chosen.sweep_index];
        for (const std::uint32_t radial : chosen.radials) {
            const UtcTime time = sweep.radials[radial].time;
            const bool dated = frame_time && level2::is_plausible(time);
            facts[at].ages_s.push_back(
                dated ? std::optional(std::chrono::duration<double>(time - *frame_time).count())
                      : std::nullopt);
        }
        if (!asked.has(Detail::distance)) continue;
        for (const level2::SweepMoment& kind : sweep.moments) {
            if (kind.moment != work.options.moment || kind.gate_spacing_m <= 0) continue;
            facts[at].places.emplace_back(
                &kind, GatePlaces(kind, work.beam, chosen.elevation_deg,
                                  static_cast<double>(work.stack.beam_width_deg) / 2));
        }
    }
    return facts;
}

bool takes_one_gate(const Method& method) {
    return facts_of(method.interpolation).takes_one_gate && method.cell == CellExtent::point;
}

// Columns of one row at a time.
class DetailColumns {
  public:
    DetailColumns(const DetailWork& work, const std::vector<SweepFacts>& facts, Grid& grid)
        : work_(work),
          method_(work.options.method),
          asked_(work.options.details),
          facts_(facts),
          grid_(grid),
          mixed_(method_.interpolation, work.stack.beam_width_deg,
                 work.stack.sweeps[0].blending()) {
        for (const double level_m : grid.spec.levels_m)
            levels_m_.push_back(static_cast<float>(level_m));
        heights_m_ = heights_of_levels(levels_m_, method_.cell);
    }

    void fill(int ix, int iy) {
        const std::size_t first = grid_.spec.index(ix, iy, 0);
        const auto status = std::span(grid_.status).subspan(first, levels_m_.size());
        const bool all_unseen = std::all_of(status.begin(), status.end(), [](CellStatus cell) {
            return cell == CellStatus::not_seen;
        });
        if (all_unseen) return;  // the column may lie beyond the tables
        const ColumnPlace& column = work_.geometry.row(iy)[static_cast<std::size_t>(ix)];
        look(column);
        const bool mixed = asked_.has(Detail::weight) && !takes_one_gate(method_);
        if (mixed) mix(column, ix, iy);
        const bool nearest = method_.interpolation == Interpolation::nearest;
        std::size_t above = 0;
        for (std::size_t level = 0; level < levels_m_.size(); ++level) {
            while (above < beams_.size() && beams_[above].height_m <= levels_m_[level])
                ++above;
            if (status[level] == CellStatus::not_seen) continue;
            const Shares shares = shares_at(beams_, above, levels_m_[level], nearest);
            describe(first + level, levels_m_[level], shares);
            if (asked_.has(Detail::weight)) {
                put(Detail::weight, first + level, mixed ? seen_share(level) : shares.seen());
            }
        }
    }

  private:
    void put(Detail detail, std::size_t cell, double value) {
        grid_.details.put(detail, cell, static_cast<float>(value));
    }

    // What each sweep's nearest radial and gate are.
    void look(const ColumnPlace& column) {
        beams_.clear();
        const ArcPlace place = ArcTable::place_of(column.arc_m);
        for (std::size_t at = 0; at < work_.stack.sweeps.size(); ++at) {
            const PolarSweep& sweep = work_.stack.sweeps[at];
            const int position = sweep.radial_at(column.azimuth_deg);
            auto heights = heights_of(sweep, position, place);
            if (!(heights.center_m < highest_beam_m)) continue;
            heights = sweep.without_lost_edges(place, heights);
            SeenBeam beam;
            beam.height_m = heights.center_m;
            beam.lower_edge_m = heights.lower_m;
            beam.upper_edge_m = heights.upper_m;
            beam.adjacent_to_next = work_.stack.adjacent_to_next[at];
            beam.is_seen = sweep.sample(position, place).status != CellStatus::not_seen;
            if (beam.is_seen) {
                beam.age_s = facts_[at].ages_s[static_cast<std::size_t>(position)];
                if (asked_.has(Detail::distance)) {
                    beam.gate = near_gate(at, position, column, place);
                }
            }
            beams_.push_back(beam);
        }
        put_in_order(std::span(beams_));
    }

    [[nodiscard]] PolarSweep::BeamHeights heights_of(const PolarSweep& sweep, int position,
                                                     ArcPlace place) const {
        const bool own = method_.radial_elevations && position != AzimuthTable::none;
        return own ? sweep.heights(place, sweep.elevation_offset_deg(position))
                   : sweep.heights(place);
    }

    [[nodiscard]] std::optional<NearGate> near_gate(std::size_t at, int position,
                                                    const ColumnPlace& column,
                                                    ArcPlace place) const {
        const PolarSweep& sweep = work_.stack.sweeps[at];
        const auto* const kind = sweep.moment_of(position);
        for (const auto& [moment, places] : facts_[at].places) {
            if (moment != kind) continue;
            const auto gate =
                static_cast<std::int32_t>(sweep.gate_place(position, place).number_and_half);
            const float offset_deg =
                method_.radial_elevations ? sweep.elevation_offset_deg(position) : 0;
            const auto center = places.at(gate, static_cast<double>(offset_deg));
            if (!center) return std::nullopt;
            const level2::Sweep& radials = work_.volume.sweeps[work_.chosen[at].sweep_index];
            const float azimuth_deg = radials.radials[sweep.radial_index(position)].azimuth_deg;
            const double turn = static_cast<double>(azimuth_deg - column.azimuth_deg) * degree;
            const auto arc_m = static_cast<double>(column.arc_m);
            // The law of cosines, so that nothing cancels.
            const double across_m =
                2 * std::sqrt(arc_m * std::max(0.0, center->arc_m)) * std::sin(turn / 2);
            return NearGate{center->height_m, std::hypot(arc_m - center->arc_m, across_m)};
        }
        return std::nullopt;
    }

    void describe(std::size_t cell, float level_m, const Shares& shares) {
        double age_s = 0;
        bool dated = true;
        std::optional<float> offset_m;
        std::optional<double> distance_m;
        for (const auto& [beam, weight] : shares.both) {
            if (beam == nullptr || !beam->is_seen) continue;
            dated = dated && beam->age_s;
            if (dated) age_s += static_cast<double>(weight) * *beam->age_s;
            const float above_m = level_m - beam->height_m;
            if (!offset_m || std::abs(above_m) < std::abs(*offset_m)) offset_m = above_m;
            if (!beam->gate) continue;
            const double far_m = std::hypot(static_cast<double>(level_m) - beam->gate->height_m,
                                            beam->gate->across_map_m);
            distance_m = std::min(distance_m.value_or(far_m), far_m);
        }
        if (!offset_m) return;
        if (asked_.has(Detail::age) && dated)
            put(Detail::age, cell, age_s / static_cast<double>(shares.seen()));
        if (asked_.has(Detail::height_offset))
            put(Detail::height_offset, cell, static_cast<double>(*offset_m));
        if (asked_.has(Detail::distance) && distance_m) put(Detail::distance, cell, *distance_m);
    }

    // The mixtures of gates of which a method with several makes the column.
    void mix(const ColumnPlace& column, int ix, int iy) {
        mixtures_.clear();
        const bool area = method_.cell == CellExtent::area;
        const Footprint footprint = area ? footprint_of(work_.geometry, ix, iy) : Footprint{};
        const ArcPlace place = ArcTable::place_of(column.arc_m);
        for (std::size_t at = 0; at < work_.stack.sweeps.size(); ++at) {
            const PolarSweep& sweep = work_.stack.sweeps[at];
            const auto heights = heights_of(sweep, sweep.radial_at(column.azimuth_deg), place);
            if (!(heights.center_m < highest_beam_m)) continue;
            const auto seen = sweep.without_lost_edges(place, heights);
            mixtures_.push_back({mixture_of(sweep, column, place, area ? &footprint : nullptr),
                                 seen.center_m, seen.lower_m, seen.upper_m,
                                 sweep.rise_m_per_deg(heights), work_.stack.adjacent_to_next[at]});
        }
        put_in_order(std::span(mixtures_));
        if (!mixtures_.empty()) mixed_.start(mixtures_);
    }

    [[nodiscard]] Mixture mixture_of(const PolarSweep& sweep, const ColumnPlace& column,
                                     ArcPlace place, const Footprint* footprint) const {
        if (footprint != nullptr) {
            const Mixture inside = gates_inside(sweep, *footprint, place);
            if (inside.weight() > 0) return inside;
        }
        if (method_.interpolation == Interpolation::eight_point)
            return four_gates(sweep, column.azimuth_deg, place);
        if (method_.interpolation == Interpolation::beam_weighted)
            return gates_by_pattern(sweep, column.azimuth_deg, place, work_.stack.beam_width_deg);
        return nearest_gate(sweep, column.azimuth_deg, place);
    }

    // Level after level, as they rise.
    [[nodiscard]] double seen_share(std::size_t level) {
        const std::size_t count = heights_m_.size() / levels_m_.size();
        float unseen = 0;
        for (std::size_t i = level * count; i < (level + 1) * count; ++i) {
            unseen += mixed_.at(heights_m_[i]).unseen();
        }
        return std::clamp(1 - static_cast<double>(unseen) / static_cast<double>(count), 0.0, 1.0);
    }

    const DetailWork& work_;
    const Method& method_;
    DetailSet asked_;
    const std::vector<SweepFacts>& facts_;
    Grid& grid_;
    std::vector<float> levels_m_, heights_m_;
    std::vector<SeenBeam> beams_;
    std::vector<BeamMixture> mixtures_;
    MixedColumn mixed_;
};

}  // namespace

void fill_details(const DetailWork& work, Grid& grid) {
    grid.details = CellDetails(work.options.details, grid.spec.cell_count());
    const std::optional<UtcTime> frame_time =
        work.options.frame_time ? work.options.frame_time : work.volume.start_time();
    const std::vector<SweepFacts> facts = facts_of(work, frame_time);
    for_each_piece(grid.spec.ny, work.options.threads, [&](int iy) {
        DetailColumns columns(work, facts, grid);
        for (int ix = 0; ix < grid.spec.nx; ++ix)
            columns.fill(ix, iy);
    });
}

}  // namespace stormcellar::grid
