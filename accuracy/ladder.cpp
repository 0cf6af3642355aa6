#include "stormcellar/accuracy/ladder.h"

#include <algorithm>
#include <array>
#include <limits>

namespace stormcellar::accuracy {
namespace {

// Returns the criteria for the Pareto front (the rows that no other row beats). Less is better.
std::array<double, 4> criteria(const LadderRow& row, TimeKind kind) {
    constexpr double unknown = std::numeric_limits<double>::infinity();
    return {kind == TimeKind::kept ? row.kept_time_s.value_or(row.time_s) : row.time_s,
            row.value ? row.value->p99 : unknown, row.position_max_m.value_or(unknown),
            row.image_p99_de.value_or(unknown)};
}

bool dominates(const LadderRow& a, const LadderRow& b, TimeKind kind) {
    const auto of_a = criteria(a, kind);
    const auto of_b = criteria(b, kind);
    bool better = false;
    for (std::size_t i = 0; i < of_a.size(); ++i) {
        if (of_a[i] > of_b[i]) return false;
        better = better || of_a[i] < of_b[i];
    }
    return better;
}

template <class T>
LadderField optional_field(std::string key, const std::optional<T>& value) {
    LadderField field{std::move(key), {}};
    if (value) field.value = *value;
    return field;
}

}  // namespace

void mark_pareto(std::span<LadderRow> rows, TimeKind kind) {
    for (LadderRow& row : rows) {
        row.pareto = std::none_of(rows.begin(), rows.end(), [&](const LadderRow& other) {
            return other.step == row.step && dominates(other, row, kind);
        });
    }
}

std::vector<LadderField> fields(const LadderRow& row, ValueUnit unit) {
    const std::string suffix = unit == ValueUnit::mps             ? "_mps"
                               : unit == ValueUnit::degree        ? "_deg"
                               : unit == ValueUnit::ratio         ? ""
                               : unit == ValueUnit::per_1000_s    ? "_per_1000_s"
                               : unit == ValueUnit::degree_per_km ? "_deg_per_km"
                               : unit == ValueUnit::mm_per_h      ? "_mm_per_h"
                                                                  : "_db";
    const auto value = [&](double ErrorSummary::*figure) {
        return row.value ? std::optional<double>((*row.value).*figure) : std::nullopt;
    };
    std::optional<double> disagreement;
    if (row.status) disagreement = row.status->share();
    return {{"step", row.step},
            {"rung", static_cast<std::uint64_t>(row.rung)},
            {"name", row.name},
            {"time_s", row.time_s},
            optional_field("kept_time_s", row.kept_time_s),
            optional_field("position_max_m", row.position_max_m),
            optional_field("position_rms_m", row.position_rms_m),
            optional_field("value_rms" + suffix, value(&ErrorSummary::rms)),
            optional_field("value_p95" + suffix, value(&ErrorSummary::p95)),
            optional_field("value_p99" + suffix, value(&ErrorSummary::p99)),
            optional_field("value_max" + suffix, value(&ErrorSummary::max)),
            optional_field("image_p99_de", row.image_p99_de),
            optional_field("status_disagreement", disagreement),
            {"pareto", row.pareto}};
}

}  // namespace stormcellar::accuracy
