#include "stormcellar/grid/audit_row.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace stormcellar::grid {
namespace {

// Pools rows. Weights their means and mean squares by the numbers of gates.
class Pool {
  public:
    void add(const AuditRow& row) {
        if (is_empty_) total_ = {row.elevation_deg, row.range_from_m, row.range_to_m};
        is_empty_ = false;
        total_.elevation_deg = std::min(total_.elevation_deg, row.elevation_deg);
        total_.range_from_m = std::min(total_.range_from_m, row.range_from_m);
        total_.range_to_m = std::max(total_.range_to_m, row.range_to_m);
        total_.sampled += row.sampled;
        total_.same_status += row.same_status;
        total_.count += row.count;
        sum_ += static_cast<double>(row.count) * static_cast<double>(row.mean);
        squares_ += static_cast<double>(row.count) * static_cast<double>(row.rms) *
                    static_cast<double>(row.rms);
    }
    [[nodiscard]] AuditRow row() const {
        AuditRow row = total_;
        if (row.count == 0) return row;
        row.rms = static_cast<float>(std::sqrt(squares_ / row.count));
        row.mean = static_cast<float>(sum_ / row.count);
        return row;
    }

  private:
    AuditRow total_;
    double sum_ = 0, squares_ = 0;
    bool is_empty_ = true;
};

std::vector<AuditRow> pooled_by(std::span<const AuditRow> rows, float AuditRow::*key) {
    std::map<float, Pool> pools;
    for (const AuditRow& row : rows)
        pools[row.*key].add(row);
    std::vector<AuditRow> made;
    made.reserve(pools.size());
    for (const auto& [value, pool] : pools)
        made.push_back(pool.row());
    return made;
}

}  // namespace

bool is_possible(const AuditRow& row) {
    const bool finite = std::isfinite(row.elevation_deg) && std::isfinite(row.range_from_m) &&
                        std::isfinite(row.rms) && std::isfinite(row.mean);
    // If all differences are equal, rounding may make their mean larger than their RMS.
    constexpr float rounding = 1.00001F;
    return finite && row.range_from_m >= 0 && row.range_to_m > row.range_from_m &&
           row.count <= row.same_status && row.same_status <= row.sampled && row.rms >= 0 &&
           std::abs(row.mean) <= rounding * row.rms;
}

AuditRow pooled(std::span<const AuditRow> rows) {
    Pool pool;
    for (const AuditRow& row : rows)
        pool.add(row);
    return pool.row();
}

std::vector<AuditRow> pooled_by_range(std::span<const AuditRow> rows) {
    return pooled_by(rows, &AuditRow::range_from_m);
}

std::vector<AuditRow> pooled_by_sweep(std::span<const AuditRow> rows) {
    return pooled_by(rows, &AuditRow::elevation_deg);
}

std::string range_text(const AuditRow& row) {
    if (std::isinf(row.range_to_m)) return fmt::format("beyond {:.0f} km", row.range_from_m / 1000);
    return fmt::format("{:.0f} to {:.0f} km", row.range_from_m / 1000, row.range_to_m / 1000);
}

std::string errors_text(const AuditRow& row, std::string_view unit) {
    const std::string status =
        row.sampled == 0 ? std::string("no gate within the grid")
                         : fmt::format("status the same in {:.1f} % of {}",
                                       100.0 * row.same_status / row.sampled, row.sampled);
    if (row.count == 0) return fmt::format("no values to compare; {}", status);
    const std::string behind = unit.empty() || unit == "1" ? "" : fmt::format(" {}", unit);
    return fmt::format("RMS {:.2f}{}, mean {:.2f}{} over {} gates; {}", row.rms, behind, row.mean,
                       behind, row.count, status);
}

}  // namespace stormcellar::grid
