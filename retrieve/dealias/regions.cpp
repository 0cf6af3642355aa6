#include "retrieve/dealias/regions.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "retrieve/dealias/offset_sets.h"

namespace stormcellar::retrieve {
namespace {

// Gates farther apart than this say nothing about each other.
constexpr std::int32_t widest_gap = 100;

// Size of the tiles into which regions are split.
constexpr std::int32_t tile_radials = 8, tile_gates = 16;

std::int8_t third_of(float turns) {
    return turns < -1.0F / 6 ? -1 : turns < 1.0F / 6 ? 0 : 1;
}

class RegionFinder {
  public:
    explicit RegionFinder(const VelocitySheet& sheet)
        : sheet_(sheet), last_(static_cast<std::size_t>(sheet.gates)) {}

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
        std::int8_t third;
        bool begins_tile;  // is cut from the radial before
    };
    struct Last {
        std::int32_t run = -1;
        std::int32_t turn = 0;  // radial number, which keeps rising on the second way round
        float value = 0;
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
        for (std::int32_t radial = 0; radial < sheet_.radials; ++radial) {
            found_.first_run.push_back(found_.runs.size());
            const std::span row(sheet_.row(radial), static_cast<std::size_t>(sheet_.gates));
            std::int32_t gate = 0;
            while (gate < sheet_.gates) {
                const float first = row[static_cast<std::size_t>(gate)];
                if (std::isnan(first)) {
                    ++gate;
                    continue;
                }
                const std::int8_t third = third_of(first);
                std::int32_t end = gate + 1;
                while (end < sheet_.gates && !std::isnan(row[static_cast<std::size_t>(end)]) &&
                       third_of(row[static_cast<std::size_t>(end)]) == third)
                    ++end;
                found_.runs.push_back({radial, gate, end, 0});
                kinds_.push_back({third, false});
                gate = end;
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
                const std::int8_t third = third_of(sheet_.row(radial)[run.begin]);
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
        const float whole = std::nearbyint(turns);
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
    // in earlier radials.
    void meet_before(std::int32_t radial, std::int32_t turn) {
        const auto r = static_cast<std::size_t>(radial);
        for (std::size_t q = found_.first_run[r]; q < found_.first_run[r + 1]; ++q)
            meet_before(static_cast<std::int32_t>(q), turn, sheet_.row(radial));
    }

    void meet_before(std::int32_t q, std::int32_t turn, const float* row) {
        const Run& run = found_.runs[static_cast<std::size_t>(q)];
        const Kind kind = kinds_[static_cast<std::size_t>(q)];
        FoldEdge edge{-1, q, {}};
        std::int32_t joined = -1;
        for (std::int32_t gate = run.begin; gate < run.end; ++gate) {
            Last& last = last_[static_cast<std::size_t>(gate)];
            const Last before = std::exchange(last, {q, turn, row[gate]});
            const std::int32_t steps = turn - before.turn;
            // On the second way round, skip pairs that have already met on the first.
            if (before.run < 0 || steps > widest_gap || before.run == q ||
                (turn != run.radial && before.turn != before_end(before)))
                continue;
            if (steps == 1) {
                ++found_.pairs;
                if (std::abs(before.value - row[gate]) > 0.5F) ++found_.jumps;
                if (!kind.begins_tile &&
                    kinds_[static_cast<std::size_t>(before.run)].third == kind.third) {
                    if (joined != before.run) sets_->join(before.run, q, 0);
                    joined = before.run;
                    continue;
                }
            }
            if (before.run != edge.a) {
                if (edge.a >= 0) found_.edges.push_back(edge);
                edge = {before.run, q, {}};
            }
            vote(edge, before.value, row[gate], 1.0F / static_cast<float>(steps));
        }
        if (edge.a >= 0) found_.edges.push_back(edge);
    }

    // Returns the turn that the gate had on the first way round.
    [[nodiscard]] std::int32_t before_end(const Last& last) const {
        return found_.runs[static_cast<std::size_t>(last.run)].radial;
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
    std::vector<Kind> kinds_;         // of each run
    std::vector<Last> last_;          // of each gate number
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
