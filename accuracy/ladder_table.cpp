// Writes the ladder as a table for people to read, with words as headings, for a terminal of 100
// columns.
#include <algorithm>
#include <array>
#include <functional>

#include <fmt/format.h>

#include "base/printable.h"
#include "stormcellar/accuracy/ladder.h"

namespace stormcellar::accuracy {
namespace {

constexpr std::size_t table_width = 100;
constexpr std::size_t gap = 2;

// Returns the number of characters, not of bytes.
std::size_t width_of(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
    }));
}

// Returns the text with at most this many characters. A text that is cut ends with three periods.
std::string shortened(const std::string& text, std::size_t most) {
    if (width_of(text) <= most) return text;
    std::string out;
    for (const char c : text) {
        const bool begins = (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
        if (begins && width_of(out) + 3 >= most) break;
        out += c;
    }
    return out + "...";
}

using Cell = std::optional<std::string>;

// A column of figures: its two lines of heading, and the function that gets its figure from a row.
struct Heading {
    const char* upper;
    const char* lower;  // {} is replaced by the unit of the values
    Cell (*cell)(const LadderRow& row);
};

Cell number_of(const std::optional<double>& number) {
    return number ? Cell(format_number(*number)) : std::nullopt;
}

constexpr std::array<Heading, 9> headings{{
    {"first", "time", [](const LadderRow& row) -> Cell { return format_seconds(row.time_s); }},
    {"further", "time",
     [](const LadderRow& row) -> Cell {
         return row.kept_time_s ? Cell(format_seconds(*row.kept_time_s)) : std::nullopt;
     }},
    {"position", "m", [](const LadderRow& row) { return number_of(row.position_max_m); }},
    {"usual", "{}",
     [](const LadderRow& row) {
         return row.value ? number_of(row.value->rms) : Cell(std::nullopt);
     }},
    {"99 in 100", "{}",
     [](const LadderRow& row) {
         return row.value ? number_of(row.value->p99) : Cell(std::nullopt);
     }},
    {"largest", "{}",
     [](const LadderRow& row) {
         return row.value ? number_of(row.value->max) : Cell(std::nullopt);
     }},
    {"color", "dE", [](const LadderRow& row) { return number_of(row.image_p99_de); }},
    {"state", "%",
     [](const LadderRow& row) -> Cell {
         return row.status ? Cell(fmt::format("{:.2f}", 100 * row.status->share())) : std::nullopt;
     }},
    {"worth", "it", [](const LadderRow& row) -> Cell { return row.pareto ? "yes" : "no"; }},
}};

struct TableColumn {
    std::string upper, lower;
    std::vector<std::string> cells;

    [[nodiscard]] std::size_t width() const {
        std::size_t widest = std::max(upper.size(), lower.size());
        for (const std::string& cell : cells)
            widest = std::max(widest, width_of(cell));
        return widest;
    }
};

std::vector<TableColumn> columns_of(std::span<const LadderRow> rows, ValueUnit unit) {
    std::vector<TableColumn> columns;
    for (const Heading& heading : headings) {
        const bool any = std::ranges::any_of(
            rows, [&](const LadderRow& row) { return heading.cell(row).has_value(); });
        if (!any) continue;
        TableColumn column{
            heading.upper, fmt::format(fmt::runtime(heading.lower), name_of(unit)), {}};
        for (const LadderRow& row : rows)
            column.cells.push_back(heading.cell(row).value_or("-"));
        columns.push_back(std::move(column));
    }
    return columns;
}

void add_line(const std::string& name, std::size_t name_width,
              const std::vector<TableColumn>& columns,
              const std::function<std::string(const TableColumn&)>& cell_of, std::string& text) {
    std::string line = name + std::string(name_width - width_of(name), ' ');
    for (const TableColumn& column : columns) {
        const std::string cell = cell_of(column);
        line += std::string(gap + column.width() - width_of(cell), ' ') + cell;
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
}

}  // namespace

std::string format_table(std::span<const LadderRow> rows, ValueUnit unit) {
    if (rows.empty()) return "";
    const std::vector<TableColumn> columns = columns_of(rows, unit);
    std::size_t figures = 0;
    for (const TableColumn& column : columns)
        figures += gap + column.width();
    const std::size_t most = table_width > figures + 12 ? table_width - figures : 12;
    std::vector<std::string> names;
    std::size_t name_width = 4;
    for (const LadderRow& row : rows) {
        names.push_back(shortened("  " + printable(row.name), most));
        name_width = std::max({name_width, width_of(names.back()), width_of(printable(row.step))});
    }
    std::string text;
    add_line(
        "", name_width, columns, [](const TableColumn& column) { return column.upper; }, text);
    add_line(
        "step", name_width, columns, [](const TableColumn& column) { return column.lower; }, text);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (i == 0 || rows[i].step != rows[i - 1].step) text += printable(rows[i].step) + "\n";
        add_line(
            names[i], name_width, columns,
            [&](const TableColumn& column) { return column.cells[i]; }, text);
    }
    return text;
}

}  // namespace stormcellar::accuracy
