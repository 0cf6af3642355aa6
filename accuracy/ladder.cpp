#include "stormcellar/accuracy/ladder.h"

#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include "base/printable.h"

namespace stormcellar::accuracy {
namespace {

// The criteria of the Pareto front. Less is better in each.
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

std::string text_of(const LadderField& field) {
    if (const auto* text = std::get_if<std::string>(&field.value)) return printable(*text);
    if (const auto* count = std::get_if<std::uint64_t>(&field.value)) {
        return fmt::format("{}", *count);
    }
    if (const auto* number = std::get_if<double>(&field.value)) return format_number(*number);
    if (const auto* yes = std::get_if<bool>(&field.value)) return *yes ? "yes" : "no";
    return "-";
}

// Returns the number of characters, not of bytes.
std::size_t width_of(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
    }));
}

struct TableColumn {
    std::string key;
    std::vector<std::string> cells;
    bool is_text = false;
    bool empty = true;

    [[nodiscard]] std::size_t width() const {
        std::size_t widest = width_of(key);
        for (const std::string& cell : cells)
            widest = std::max(widest, width_of(cell));
        return widest;
    }
};

std::vector<TableColumn> columns_of(std::span<const LadderRow> rows, ValueUnit unit) {
    std::vector<TableColumn> columns;
    for (const LadderRow& row : rows) {
        const auto list = fields(row, unit);
        columns.resize(list.size());
        for (std::size_t i = 0; i < list.size(); ++i) {
            columns[i].key = list[i].key;
            columns[i].cells.push_back(text_of(list[i]));
            columns[i].is_text =
                columns[i].is_text || std::holds_alternative<std::string>(list[i].value);
            columns[i].empty =
                columns[i].empty && std::holds_alternative<std::monostate>(list[i].value);
        }
    }
    std::erase_if(columns, [](const TableColumn& column) { return column.empty; });
    return columns;
}

std::string padded(const TableColumn& column, const std::string& text) {
    const std::string blanks(column.width() - width_of(text), ' ');
    return column.is_text ? text + blanks : blanks + text;
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
    const std::string suffix = unit == ValueUnit::mps      ? "_mps"
                               : unit == ValueUnit::degree ? "_deg"
                               : unit == ValueUnit::ratio  ? ""
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

std::string format_table(std::span<const LadderRow> rows, ValueUnit unit) {
    const auto columns = columns_of(rows, unit);
    std::string text;
    const auto add_line = [&](const auto& cell_of) {
        std::string line;
        for (const TableColumn& column : columns) {
            if (!line.empty()) line += "  ";
            line += padded(column, cell_of(column));
        }
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    };
    if (rows.empty()) return text;
    add_line([](const TableColumn& column) { return column.key; });
    for (std::size_t i = 0; i < rows.size(); ++i) {
        add_line([&](const TableColumn& column) { return column.cells[i]; });
    }
    return text;
}

}  // namespace stormcellar::accuracy
