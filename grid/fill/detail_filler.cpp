#include "grid/fill/detail_filler.h"

#include <algorithm>
#include <cmath>

#include "base/degree.h"
#include "base/parallel.h"
#include "grid/beam/gate_places.h"
#include "grid/fill/beam_choice.h"
#include "grid/fill/mixed_column.h"
#include "grid/fill/tile_columns.h"
#include "grid/place/footprint.h"

namespace stormcellar::grid {
namespace {

// The facts about a sweep that the details need, besides its gates.
struct SweepFacts {
    std::vector<std::optional<double>> ages_s;  // by position of the radial
    // Places of the gates of each kind; empty unless the caller asks for distances.
    std::vector<std::pair<const level2::SweepMoment*, GatePlaces>> places;
};

// The center of the gate that is nearest to a column, in one sweep. Its place is relative to the
// column.
struct NearGate {
    double height_m = 0;
    double across_map_m = 0;  // distance from the column in the plane about the site
};

struct SeenBeam {
    float height_m = 0, lower_edge_m = 0, upper_edge_m = 0;
    bool adjacent_to_next = true;
    bool is_seen = false;
    std::optional<double> age_s;
    std::optional<NearGate> gate;
};

// A sweep that contributes at a height, and its weight. There is no sweep if the height is not
// seen.
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

// Returns the one or two sweeps from which grid/fill/column.h fills a level, with their weights.
// The heights of the beams rise. `above` is the index of the first beam above the level, or the
// number of beams if there is none.
Shares shares_at(std::span<const SeenBeam> beams, std::size_t above, float level_m, bool nearest) {
    const SeenBeam* const low = above > 0 ? &beams[above - 1] : nullptr;
    const SeenBeam* const high = above < beams.size() ? &beams[above] : nullptr;
    Shares shares;
    if (low == nullptr || high == nullptr || !low->adjacent_to_next) {
        const SeenBeam* const alone = beam_alone(low, high, level_m);
        if (alone != nullptr) shares.both[0] = {alone, 1};
        return shares;
    }
    const float linear = (level_m - low->height_m) / (high->height_m - low->height_m);
    const float high_weight = upper_share(linear, nearest);
    if (high_weight < 1) shares.both[0] = {low, 1 - high_weight};
    if (high_weight > 0) shares.both[1] = {high, high_weight};
    return shares;
}

// Collects what does not depend on the column: the ages of the radials and, if the caller asks for
// distances, the places of the gates.
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

// Fills the details of columns, one row at a time.
class DetailColumns {
  public:
    DetailColumns(const DetailWork& work, const std::vector<SweepFacts>& facts, Grid& grid)
        : work_(work),
          method_(work.options.method),
          asked_(work.options.details),
          facts_(facts),
          grid_(grid),
          mixed_(method_.interpolation, work.stack.beam_width_deg,
                 work.stack.sweeps[0].gates().blending()) {
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
        if (all_unseen) return;  // the column may be beyond the end of the tables
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

    // Finds the nearest radial and the nearest gate of each sweep.
    void look(const ColumnPlace& column) {
        beams_.clear();
        const ArcPlace place = ArcTable::place_of(column.arc_m);
        for (std::size_t at = 0; at < work_.stack.sweeps.size(); ++at) {
            const PolarSweep& sweep = work_.stack.sweeps[at];
            const int position = sweep.radial_at(column.azimuth_deg);
            const BeamMixture over = beam_over(sweep, method_, column.azimuth_deg, place);
            if (!(over.height_m < highest_beam_m)) continue;
            SeenBeam beam;
            beam.height_m = over.height_m;
            beam.lower_edge_m = over.lower_edge_m;
            beam.upper_edge_m = over.upper_edge_m;
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

    [[nodiscard]] std::optional<NearGate> near_gate(std::size_t at, int position,
                                                    const ColumnPlace& column,
                                                    ArcPlace place) const {
        const PolarSweep& sweep = work_.stack.sweeps[at];
        const auto* const kind = sweep.gates().moment_of(position);
        for (const auto& [moment, places] : facts_[at].places) {
            if (moment != kind) continue;
            const auto gate = static_cast<std::int32_t>(
                sweep.gates().gate_place(position, place).number_and_half);
            const float offset_deg =
                method_.radial_elevations ? sweep.gates().elevation_offset_deg(position) : 0;
            const auto center = places.at(gate, static_cast<double>(offset_deg));
            if (!center) return std::nullopt;
            const level2::Sweep& radials = work_.volume.sweeps[work_.chosen[at].sweep_index];
            const float azimuth_deg =
                radials.radials[sweep.gates().radial_index(position)].azimuth_deg;
            const double turn = static_cast<double>(azimuth_deg - column.azimuth_deg) * degree;
            const auto arc_m = static_cast<double>(column.arc_m);
            // The law of cosines, in a form in which nothing cancels.
            const double across_m =
                2 * std::sqrt(arc_m * std::max(0.0, center->arc_m)) * std::sin(turn / 2);
            return NearGate{center->height_m, std::hypot(arc_m - center->arc_m, across_m)};
        }
        return std::nullopt;
    }

    // Writes the age, the height offset and the distance of a cell. The age is the mean of the ages
    // of the sweeps, weighted by their shares. The height offset is to the nearest beam, and the
    // distance to the nearest gate.
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

    // Mixes gates of each sweep in the same way as a method that fills the column from several
    // gates.
    void mix(const ColumnPlace& column, int ix, int iy) {
        mixtures_.clear();
        const bool area = method_.cell == CellExtent::area;
        const Footprint footprint = area ? footprint_of(work_.geometry, ix, iy) : Footprint{};
        const ArcPlace place = ArcTable::place_of(column.arc_m);
        for (std::size_t at = 0; at < work_.stack.sweeps.size(); ++at) {
            const PolarSweep& sweep = work_.stack.sweeps[at];
            BeamMixture beam = beam_over(sweep, method_, column.azimuth_deg, place);
            if (!(beam.height_m < highest_beam_m)) continue;
            beam.adjacent_to_next = work_.stack.adjacent_to_next[at];
            beam.mixture = mixture_over(sweep, method_, work_.stack.beam_width_deg,
                                        column.azimuth_deg, place, area ? &footprint : nullptr);
            mixtures_.push_back(beam);
        }
        put_in_order(std::span(mixtures_));
        if (!mixtures_.empty()) mixed_.start(mixtures_);
    }

    // Returns how much of a level is seen, as a share. Call it in rising order of levels.
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
