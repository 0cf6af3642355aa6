#include "retrieve/dealias/regions.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "retrieve/dealias/offset_sets.h"

namespace stormcellar::retrieve {
namespace {

// Gates farther apart than this say nothing about each other.
constexpr std::int32_t widest_gap = 100;

// Size of the tiles into which regions are split.
constexpr std::int32_t tile_radials = 8, tile_gates = 16;

// Returns the number of the third, from 1 to 3, or 0 if there is no value. The function has no
// branches, so that the compiler handles several gates at once.
std::uint8_t third_of(float turns) {
    // Comparing NaN with >= would be an invalid operation (base/floating_point.h).
    const int number = (turns == turns ? 1 : 0) + (std::isgreaterequal(turns, -1.0F / 6) ? 1 : 0) +
                       (std::isgreaterequal(turns, 1.0F / 6) ? 1 : 0);
    return static_cast<std::uint8_t>(number);
}

class RegionFinder {
  public:
    explicit RegionFinder(const VelocitySheet& sheet)
        : sheet_(sheet), last_run_(static_cast<std::size_t>(sheet.gates), -1) {}

    SheetRegions find() {
        cut_runs();
        return find_between_runs();
    }

    SheetRegions split(const SheetRegions& regions, const std::vector<std::uint8_t>& is_split) {
        cut_runs(regions, is_split);
        SheetRegions found = find_between_runs();
        found.pairs = regions.pairs;
        found.jumps = regions.jumps;
        return found;
    }

  private:
    struct Kind {
        std::uint8_t third;
        bool begins_tile;  // is cut from the radial before
    };
    SheetRegions find_between_runs() {
        sets_.emplace(static_cast<std::int32_t>(found_.runs.size()));
        for (std::int32_t radial = 0; radial < sheet_.radials; ++radial) {
            meet_along(radial);
            meet_before(radial, radial);
        }
        // Let gates at the beginning of a circle meet the gates at its end.
        if (sheet_.is_circle) {
            for (std::int32_t radial = 0; radial < std::min(widest_gap, sheet_.radials); ++radial)
                meet_before(radial, radial + sheet_.radials);
        }
        name_regions();
        return std::move(found_);
    }

    void cut_runs() {
        // No gate has the number 4, so it ends the last run of a radial.
        std::vector<std::uint8_t> thirds(static_cast<std::size_t>(sheet_.gates) + 1, 4);
        for (std::int32_t radial = 0; radial < sheet_.radials; ++radial) {
            found_.first_run.push_back(found_.runs.size());
            std::transform(sheet_.row(radial), sheet_.row(radial) + sheet_.gates, thirds.begin(),
                           third_of);
            for (auto begin = thirds.begin(); begin != thirds.end() - 1;) {
                const std::uint8_t third = *begin;
                const auto end = std::find_if(begin + 1, thirds.end(),
                                              [&](std::uint8_t other) { return other != third; });
                if (third != 0) {
                    found_.runs.push_back({radial,
                                           static_cast<std::int32_t>(begin - thirds.begin()),
                                           static_cast<std::int32_t>(end - thirds.begin()), 0});
                    kinds_.push_back({third, false});
                }
                begin = end;
            }
        }
        found_.first_run.push_back(found_.runs.size());
    }

    void cut_runs(const SheetRegions& regions, const std::vector<std::uint8_t>& is_split) {
        for (std::int32_t radial = 0; radial < sheet_.radials; ++radial) {
            const auto r = static_cast<std::size_t>(radial);
            found_.first_run.push_back(found_.runs.size());
            for (std::size_t q = regions.first_run[r]; q < regions.first_run[r + 1]; ++q) {
                const Run& run = regions.runs[q];
                const bool is_cut = is_split[static_cast<std::size_t>(run.region)] != 0;
                const std::uint8_t third = third_of(sheet_.row(radial)[run.begin]);
                for (std::int32_t begin = run.begin; begin < run.end;) {
                    const std::int32_t end =
                        is_cut ? std::min(run.end, (begin / tile_gates + 1) * tile_gates) : run.end;
                    found_.runs.push_back({radial, begin, end, 0});
                    kinds_.push_back({third, is_cut && radial % tile_radials == 0});
                    begin = end;
                }
            }
        }
        found_.first_run.push_back(found_.runs.size());
    }

    static void vote(FoldEdge& edge, float a, float b, float weight) {
        const float turns = a - b;  // by how much b is too low
        const float whole = nearest_whole(turns);
        edge.votes.add(static_cast<int>(whole), weight * vote_weight(turns - whole));
    }

    // Adds the votes between each run of a radial and the run before it.
    void meet_along(std::int32_t radial) {
        const auto r = static_cast<std::size_t>(radial);
        for (std::size_t q = found_.first_run[r] + 1; q < found_.first_run[r + 1]; ++q) {
            const Run &before = found_.runs[q - 1], &run = found_.runs[q];
            const std::int32_t steps = run.begin - before.end + 1;
            if (steps > widest_gap) continue;
            FoldEdge edge{static_cast<std::int32_t>(q - 1), static_cast<std::int32_t>(q), {}};
            const float* row = sheet_.row(radial);
            vote(edge, row[before.end - 1], row[run.begin], 1.0F / static_cast<float>(steps));
            if (steps == 1) {
                ++found_.pairs;
                if (std::abs(row[before.end - 1] - row[run.begin]) > 0.5F) ++found_.jumps;
            }
            found_.edges.push_back(edge);
        }
    }

    // Adds the votes between each gate of a radial and the last gate with a value at the same range
    // in earlier radials. `turn` is the number of the radial, which keeps rising on the second way
    // round.
    void meet_before(std::int32_t radial, std::int32_t turn) {
        const auto r = static_cast<std::size_t>(radial);
        for (std::size_t q = found_.first_run[r]; q < found_.first_run[r + 1]; ++q) {
            meet_runs_before(static_cast<std::int32_t>(q), turn);
            // On the second way round, later radials have already met this one.
            const Run& run = found_.runs[q];
            std::fill(last_run_.begin() + run.begin, last_run_.begin() + run.end,
                      turn == radial ? static_cast<std::int32_t>(q) : -1);
        }
    }

    void meet_runs_before(std::int32_t q, std::int32_t turn) {
        const Run& run = found_.runs[static_cast<std::size_t>(q)];
        const Kind kind = kinds_[static_cast<std::size_t>(q)];
        const float* row = sheet_.row(run.radial);
        FoldEdge edge{-1, q, {}};
        for (std::int32_t gate = run.begin; gate < run.end;) {
            const std::int32_t b = last_run_[static_cast<std::size_t>(gate)];
            if (b < 0 || b == q) {
                ++gate;
                continue;
            }
            const Run& before = found_.runs[static_cast<std::size_t>(b)];
            const std::int32_t steps = turn - before.radial;
            // All gates of a run in the radial before are the last at their ranges.
            const std::int32_t end = steps == 1 ? std::min(run.end, before.end) : gate + 1;
            if (steps == 1) found_.pairs += end - gate;
            if (steps == 1 && !kind.begins_tile &&
                kinds_[static_cast<std::size_t>(b)].third == kind.third) {
                sets_->join(b, q, 0);
            } else if (steps <= widest_gap) {
                if (b != edge.a) {
                    if (edge.a >= 0) found_.edges.push_back(edge);
                    edge = {b, q, {}};
                }
                vote_of_gates(edge, sheet_.row(before.radial), row, gate, end, steps);
            }
            gate = end;
        }
        if (edge.a >= 0) found_.edges.push_back(edge);
    }

    void vote_of_gates(FoldEdge& edge, const float* before, const float* row, std::int32_t begin,
                       std::int32_t end, std::int32_t steps) {
        const float weight = 1.0F / static_cast<float>(steps);
        for (std::int32_t gate = begin; gate < end; ++gate) {
            vote(edge, before[gate], row[gate], weight);
            if (steps == 1 && std::abs(before[gate] - row[gate]) > 0.5F) ++found_.jumps;
        }
    }

    void name_regions() {
        std::vector<std::int32_t> region_of_root(found_.runs.size(), -1);
        for (std::size_t q = 0; q < found_.runs.size(); ++q) {
            const auto root =
                static_cast<std::size_t>(sets_->find(static_cast<std::int32_t>(q)).root);
            if (region_of_root[root] < 0) {
                region_of_root[root] = static_cast<std::int32_t>(found_.gate_count.size());
                found_.gate_count.push_back(0);
            }
            Run& run = found_.runs[q];
            run.region = region_of_root[root];
            found_.gate_count[static_cast<std::size_t>(run.region)] += run.end - run.begin;
        }
        for (FoldEdge& edge : found_.edges) {
            edge.a = found_.runs[static_cast<std::size_t>(edge.a)].region;
            edge.b = found_.runs[static_cast<std::size_t>(edge.b)].region;
        }
    }

    const VelocitySheet& sheet_;
    SheetRegions found_;
    std::vector<Kind> kinds_;  // of each run
    // The last run with a value at each gate number.
    std::vector<std::int32_t> last_run_;
    std::optional<OffsetSets> sets_;  // of runs
};

}  // namespace

SheetRegions find_regions(const VelocitySheet& sheet) {
    return RegionFinder(sheet).find();
}

SheetRegions split_regions(const VelocitySheet& sheet, const SheetRegions& regions,
                           const std::vector<std::uint8_t>& is_split) {
    return RegionFinder(sheet).split(regions, is_split);
}

}  // namespace stormcellar::retrieve
