#include "grid/beam/sounding.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "base/printable.h"
#include "stormcellar/base/file_system.h"

namespace stormcellar::grid {
namespace {

constexpr std::size_t largest_file = 1 << 20;
constexpr std::size_t most_columns = 100;
constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
constexpr double kelvin_at_0_c = 273.15;

enum Column : std::size_t { height, n_units, pressure, temperature, dew_point, humidity, count };

struct ColumnRule {
    std::string_view name;
    double least = 0, most = 0;
};
constexpr std::array<ColumnRule, Column::count> rules = {{
    {"height_m", RefractivityProfile::least_height_m, RefractivityProfile::greatest_height_m},
    {"refractivity", 1e-9, RefractivityProfile::greatest_n_units},
    {"pressure_hpa", 1e-4, 1100},
    {"temperature_c", -120, 60},
    {"dew_point_c", -150, 40},
    {"relative_humidity_percent", 0, 100},
}};

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// Returns the text before the next separator. Removes this text and the separator from the front of
// `rest`.
std::string_view take(std::string_view& rest, char separator) {
    const auto end = rest.find(separator);
    const std::string_view piece = rest.substr(0, end);
    rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
    return piece;
}

double refractivity_of_vapour(double pressure_hpa, double temperature_c, double vapour_hpa) {
    const double kelvin = temperature_c + kelvin_at_0_c;
    return 77.6 * pressure_hpa / kelvin + 3.73e5 * vapour_hpa / (kelvin * kelvin);
}

// Reads the lines of one file from top to bottom.
class Reader {
  public:
    Reader(std::string_view text, const std::string& name) : rest_(text), name_(name) {
        if (rest_.starts_with(byte_order_mark)) rest_.remove_prefix(byte_order_mark.size());
    }

    Result<std::vector<RefractivityLevel>> levels();

  private:
    using Row = std::array<double, Column::count>;

    // Returns the next line that is not empty or a comment; none at the end.
    std::optional<std::string_view> next_line();
    Status read_header();
    Result<Row> read_row(std::string_view line) const;
    Status check(const Row& row) const;
    [[nodiscard]] RefractivityLevel level(const Row& row) const;
    [[nodiscard]] bool has(Column column) const { return place_[column].has_value(); }

    template <class... Args>
    [[nodiscard]] tl::unexpected<Error> wrong(fmt::format_string<Args...> format,
                                              Args&&... args) const {
        return fail(ErrorCode::bad_argument, "{}:{}: {}", printable(name_), line_number_,
                    fmt::format(format, std::forward<Args>(args)...));
    }

    std::string_view rest_;
    const std::string& name_;
    std::size_t line_number_ = 0;
    std::size_t column_count_ = 0;
    // the position of each column in a line
    std::array<std::optional<std::size_t>, Column::count> place_;
    std::optional<Row> below_;
};

std::optional<std::string_view> Reader::next_line() {
    while (!rest_.empty()) {
        std::string_view line = take(rest_, '\n');
        ++line_number_;
        line = trimmed(line.substr(0, line.find('#')));
        if (!line.empty()) return line;
    }
    return std::nullopt;
}

Status Reader::read_header() {
    const auto line = next_line();
    if (!line) {
        return fail(ErrorCode::bad_argument, "{}: no line names the columns", printable(name_));
    }
    column_count_ = 1 + static_cast<std::size_t>(std::count(line->begin(), line->end(), ','));
    if (column_count_ > most_columns) {
        return wrong("there are {} columns, more than {}", column_count_, most_columns);
    }
    std::string_view rest = *line;
    for (std::size_t i = 0; i < column_count_; ++i) {
        const std::string_view column = trimmed(take(rest, ','));
        for (std::size_t c = 0; c < Column::count; ++c) {
            if (column != rules[c].name) continue;
            if (place_[c]) return wrong("column {} is named twice", column);
            place_[c] = i;
        }
    }
    if (!has(height)) return wrong("there is no column height_m");
    if (has(n_units)) return {};
    if (!has(pressure)) return wrong("there is no column refractivity or pressure_hpa");
    if (!has(temperature)) return wrong("there is no column temperature_c");
    if (has(dew_point) == has(humidity)) {
        return wrong(
            "there must be exactly one of the columns dew_point_c and relative_humidity_percent");
    }
    return {};
}

Result<Reader::Row> Reader::read_row(std::string_view line) const {
    const std::size_t found =
        1 + static_cast<std::size_t>(std::count(line.begin(), line.end(), ','));
    if (found != column_count_) return wrong("there are {} columns, not {}", found, column_count_);
    std::vector<std::string_view> pieces;
    for (std::size_t i = 0; i < column_count_; ++i)
        pieces.push_back(trimmed(take(line, ',')));
    Row row{};
    for (std::size_t c = 0; c < Column::count; ++c) {
        if (!place_[c]) continue;
        const std::string_view piece = pieces[*place_[c]];
        const char* const end = piece.data() + piece.size();
        const auto [stopped, error] = std::from_chars(piece.data(), end, row[c]);
        if (piece.empty() || error != std::errc{} || stopped != end || !std::isfinite(row[c])) {
            return wrong("column {} (number {}): not a number: '{}'", rules[c].name, *place_[c] + 1,
                         printable(piece.substr(0, 40)));
        }
        if (row[c] < rules[c].least || row[c] > rules[c].most) {
            return wrong("column {} (number {}): {} is not from {} to {}", rules[c].name,
                         *place_[c] + 1, row[c], rules[c].least, rules[c].most);
        }
    }
    return row;
}

Status Reader::check(const Row& row) const {
    if (below_ && !(row[height] > (*below_)[height])) {
        return wrong("column height_m: {} is not above the one before, {}", row[height],
                     (*below_)[height]);
    }
    if (!below_ && row[height] > RefractivityProfile::highest_first_level_m) {
        return wrong("column height_m: the first level, {}, is above {}", row[height],
                     RefractivityProfile::highest_first_level_m);
    }
    if (has(n_units)) return {};
    if (below_ && row[pressure] > (*below_)[pressure]) {
        return wrong("column pressure_hpa: {} is more than {} below it", row[pressure],
                     (*below_)[pressure]);
    }
    if (has(dew_point) && row[dew_point] > row[temperature]) {
        return wrong("column dew_point_c: {} is above the temperature, {}", row[dew_point],
                     row[temperature]);
    }
    return {};
}

RefractivityLevel Reader::level(const Row& row) const {
    if (has(n_units)) return {row[height], row[n_units]};
    const double vapour_hpa = has(dew_point)
                                  ? saturation_pressure_hpa(row[dew_point])
                                  : row[humidity] / 100 * saturation_pressure_hpa(row[temperature]);
    return {row[height], refractivity_of_vapour(row[pressure], row[temperature], vapour_hpa)};
}

Result<std::vector<RefractivityLevel>> Reader::levels() {
    if (const Status header = read_header(); !header) return pass_on(header);
    std::vector<RefractivityLevel> levels;
    while (const auto line = next_line()) {
        const auto row = read_row(*line);
        if (!row) return pass_on(row);
        if (const Status sound = check(*row); !sound) return pass_on(sound);
        if (levels.size() == RefractivityProfile::greatest_level_count) {
            return wrong("there are more than {} levels",
                         RefractivityProfile::greatest_level_count);
        }
        levels.push_back(level(*row));
        if (levels.back().n_units > RefractivityProfile::greatest_n_units) {
            return wrong("the refractivity, {:.4g}, is above {}", levels.back().n_units,
                         RefractivityProfile::greatest_n_units);
        }
        if (levels.size() > 1) {
            const RefractivityLevel& low = levels[levels.size() - 2];
            const double gradient =
                (levels.back().n_units - low.n_units) / (levels.back().height_m - low.height_m);
            if (!(std::abs(gradient) <= RefractivityProfile::greatest_gradient_per_m)) {
                return wrong("the refractivity changes by {:.3g} per meter, more than {}", gradient,
                             RefractivityProfile::greatest_gradient_per_m);
            }
        }
        below_ = *row;
    }
    if (levels.size() < 2) {
        return fail(ErrorCode::bad_argument, "{}: has {} levels, but at least 2 are needed",
                    printable(name_), levels.size());
    }
    return levels;
}

}  // namespace

double saturation_pressure_hpa(double temperature_c) {
    return 6.1121 * std::exp(17.502 * temperature_c / (temperature_c + 240.97));
}

double refractivity(double pressure_hpa, double temperature_c, double dew_point_c) {
    return refractivity_of_vapour(pressure_hpa, temperature_c,
                                  saturation_pressure_hpa(dew_point_c));
}

Result<RefractivityProfile> parse_sounding(std::string_view text, const std::string& name) {
    if (text.size() > largest_file) {
        return fail(ErrorCode::bad_argument, "{}: has {} bytes, more than {}", printable(name),
                    text.size(), largest_file);
    }
    const auto levels = Reader(text, name).levels();
    if (!levels) return pass_on(levels);
    const std::filesystem::path path(name);
    return RefractivityProfile::from_levels(
        *levels, fmt::format("sounding {}", printable(path.filename().native())));
}

Result<RefractivityProfile> read_sounding(const std::filesystem::path& file) {
    const auto bytes = read_file(file, largest_file);
    if (!bytes) return pass_on(bytes);
    return parse_sounding({reinterpret_cast<const char*>(bytes->data()), bytes->size()},
                          file.native());
}

}  // namespace stormcellar::grid
