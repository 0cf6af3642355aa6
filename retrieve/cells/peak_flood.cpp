#include "retrieve/cells/peak_flood.h"

#include <array>
#include <cmath>
#include <utility>

namespace stormcellar::retrieve {
namespace {

struct FloodStep {
    int x, y, z;
};
constexpr std::array<FloodStep, 10> flood_steps = {{{1, 0, 0},
                                                    {-1, 0, 0},
                                                    {0, 1, 0},
                                                    {0, -1, 0},
                                                    {0, 0, 1},
                                                    {0, 0, -1},
                                                    {1, 1, 0},
                                                    {1, -1, 0},
                                                    {-1, 1, 0},
                                                    {-1, -1, 0}}};

// A group of cells around a peak. Groups that joined point to each other, as in a union-find.
struct FloodGroup {
    std::int32_t parent = 0;
    StrongGridCell peak;
    int cells = 0;
};

class PeakFlood {
  public:
    PeakFlood(const StrongEcho& echo, const FloodRules& rules) : echo_(echo), rules_(rules) {
        group_of_.assign(echo.cells().size(), -1);
    }

    FloodedEcho run() {
        for (std::size_t i = 0; i < group_of_.size(); ++i)
            add(i);
        return numbered();
    }

  private:
    std::int32_t root_of(std::int32_t group) {
        while (at(group).parent != group)
            group = at(group).parent = at(at(group).parent).parent;
        return group;
    }
    FloodGroup& at(std::int32_t group) { return groups_[static_cast<std::size_t>(group)]; }

    // Adds the next cell. The cell joins the group of its strongest neighbor. If no neighbor has a
    // group yet, the cell is a new peak. Then all groups that meet at this cell join, unless the
    // rules keep them apart.
    void add(std::size_t i) {
        const StrongGridCell& cell = echo_.cells()[i];
        std::array<std::int32_t, flood_steps.size()> met{};
        std::size_t count = 0;
        std::int32_t strongest = -1, strongest_neighbor = -1;
        for (const FloodStep& step : flood_steps) {
            const std::int32_t neighbor =
                echo_.at(cell.ix + step.x, cell.iy + step.y, cell.iz + step.z);
            if (neighbor < 0 || group_of_[static_cast<std::size_t>(neighbor)] < 0) continue;
            const std::int32_t group = root_of(group_of_[static_cast<std::size_t>(neighbor)]);
            met[count++] = group;
            if (strongest_neighbor < 0 || neighbor < strongest_neighbor) {
                strongest_neighbor = neighbor;
                strongest = group;
            }
        }
        if (count == 0) {
            strongest = static_cast<std::int32_t>(groups_.size());
            groups_.push_back({strongest, cell, 0});
        }
        group_of_[i] = strongest;
        ++at(strongest).cells;
        for (std::size_t a = 0; a < count; ++a) {
            for (std::size_t b = a + 1; b < count; ++b)
                join(root_of(met[a]), root_of(met[b]), cell);
        }
    }

    void join(std::int32_t a, std::int32_t b, const StrongGridCell& pass) {
        if (a == b) return;
        // Groups are numbered from their peaks down, so the smaller number has the stronger peak.
        if (b < a) std::swap(a, b);
        if (stays_apart(at(a), at(b), pass)) return;
        at(b).parent = a;
        at(a).cells += at(b).cells;
    }

    [[nodiscard]] bool stays_apart(const FloodGroup& stronger, const FloodGroup& weaker,
                                   const StrongGridCell& pass) const {
        const float rise_db = echo_.dbz_of(weaker.peak.level) - echo_.dbz_of(pass.level);
        if (rise_db < rules_.prominence_db || weaker.cells < rules_.least_cells) return false;
        const double x_m = (stronger.peak.ix - weaker.peak.ix) * rules_.cell_width_m;
        const double y_m = (stronger.peak.iy - weaker.peak.iy) * rules_.cell_height_m;
        return std::hypot(x_m, y_m) >= rules_.separation_m;
    }

    FloodedEcho numbered() {
        FloodedEcho flooded;
        std::vector<std::int32_t> numbers(groups_.size(), -1);
        for (std::int32_t group = 0; group < static_cast<std::int32_t>(groups_.size()); ++group) {
            if (root_of(group) == group)
                numbers[static_cast<std::size_t>(group)] = flooded.groups++;
        }
        flooded.group_of.reserve(group_of_.size());
        for (const std::int32_t group : group_of_)
            flooded.group_of.push_back(numbers[static_cast<std::size_t>(root_of(group))]);
        return flooded;
    }

    const StrongEcho& echo_;
    const FloodRules& rules_;
    std::vector<FloodGroup> groups_;
    std::vector<std::int32_t> group_of_;
};

}  // namespace

FloodedEcho flood_peaks(const StrongEcho& echo, const FloodRules& rules) {
    return PeakFlood(echo, rules).run();
}

}  // namespace stormcellar::retrieve
