#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/parse_number.h"
#include "base/printable.h"
#include "render/overlay/shape_file.h"
#include "render/overlay/shape_values.h"

namespace stormcellar::render {
namespace {

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// Splits a line at commas that are not inside quotes, and removes the quotes.
std::vector<std::string> fields_of(std::string_view text) {
    std::vector<std::string> fields(1);
    bool is_quoted = false;
    for (const char letter : text) {
        if (letter == '"') {
            is_quoted = !is_quoted;
        } else if (letter == ',' && !is_quoted) {
            fields.emplace_back();
        } else {
            fields.back() += letter;
        }
    }
    for (std::string& field : fields)
        field = std::string(trimmed(field));
    return fields;
}

std::optional<double> number_of(std::string_view text) {
    const auto value = parse_number<double>(text);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

constexpr std::size_t longest_line = 10'000;

class PlacefileReader {
  public:
    Status read(std::string_view text) {
        while (!text.empty()) {
            const std::size_t end = std::min(text.find('\n'), text.size());
            ++number_;
            if (end > longest_line) return fail(ErrorCode::corrupt, "line {} is too long", number_);
            if (Status read = take_line(trimmed(text.substr(0, end))); !read)
                return fail(read.error().code, "line {}: {}", number_, read.error().message);
            text.remove_prefix(std::min(end + 1, text.size()));
        }
        if (statements_ == 0)
            return fail(ErrorCode::corrupt, "it is neither GeoJSON nor placefile");
        end_block();
        return {};
    }
    ShapeOverlay taken;

  private:
    enum class Block { none, line, object, unknown };

    Status take_line(std::string_view line) {
        if (line.empty() || line.front() == ';') return {};
        const std::size_t colon = line.find(':');
        const std::string_view name = line.substr(0, colon);
        const bool is_statement =
            colon != std::string_view::npos && std::ranges::all_of(name, [](unsigned char letter) {
                return std::isalpha(letter) != 0;
            });
        if (!is_statement) return take_place_line(line);
        return take_statement(name, trimmed(line.substr(colon + 1)));
    }

    Status take_statement(std::string_view name, std::string_view value) {
        ++statements_;
        if (name == "End") {
            if (is_in_inner_block_) {
                is_in_inner_block_ = false;
            } else {
                end_block();
            }
            return {};
        }
        if (name == "Color") return take_color(value);
        if (name == "TimeRange") return take_times(value);
        if (name == "Text" || name == "Place" || name == "Icon") return take_point(name, value);
        if (name == "Object") {
            end_block();
            is_in_inner_block_ = false;
            block_ = Block::object;
            return take_object(value);
        }
        const bool is_line = name == "Line" || name == "Polygon";
        const bool is_block = is_line || name == "Triangles" || name == "Image";
        if (!is_block) return {};  // titles, fonts, refresh times and the like
        if (block_ == Block::object) {
            ++taken.unknown;
            is_in_inner_block_ = true;
            return {};
        }
        end_block();
        if (!is_line) {
            ++taken.unknown;
            block_ = Block::unknown;
            return {};
        }
        block_ = Block::line;
        shape_ = style_;
        if (const auto width = number_of(fields_of(value).front()); name == "Line" && width)
            shape_.width = static_cast<float>(std::clamp(*width, 0.5, 20.0));
        is_area_ = name == "Polygon";
        return {};
    }

    Status take_color(std::string_view value) {
        Rgba8 color = {0, 0, 0, 255};
        std::string words(value);
        std::ranges::replace_if(
            words, [](char letter) { return letter == ',' || letter == '\t'; }, ' ');
        std::size_t part = 0;
        std::string_view rest = words;
        while (part < 3) {
            rest = trimmed(rest);
            const std::size_t end = std::min(rest.find(' '), rest.size());
            const auto level = number_of(rest.substr(0, end));
            if (!level || *level < 0 || *level > 255)
                return fail(ErrorCode::corrupt, "'{}' is no color such as 255 0 0",
                            printable(value));
            color[part++] = static_cast<std::uint8_t>(*level);
            rest.remove_prefix(end);
        }
        style_.color = color;
        return {};
    }

    Status take_times(std::string_view value) {
        const std::size_t space = std::min(value.find(' '), value.size());
        const auto from = shape_time(value.substr(0, space));
        if (!from) return pass_on(from);
        const auto until = shape_time(trimmed(value.substr(space)));
        if (!until) return pass_on(until);
        style_.from = *from;
        style_.until = *until;
        return {};
    }

    Result<grid::GeoPoint> place_of(const std::vector<std::string>& fields) {
        const auto latitude = number_of(fields[0]);
        const auto longitude = fields.size() > 1 ? number_of(fields[1]) : std::nullopt;
        if (!latitude || !longitude)
            return fail(ErrorCode::corrupt, "'{}' does not begin with a latitude and a longitude",
                        printable(fields[0]));
        if (++points_ > most_shape_points)
            return fail(ErrorCode::over_budget, "it has more than {} points", most_shape_points);
        return shape_place(*latitude, *longitude);
    }

    // Places in an Object are pixels from the place of the object.
    Status take_point(std::string_view name, std::string_view value) {
        const std::vector<std::string> fields = fields_of(value);
        OverlayShape point = style_;
        if (block_ == Block::object) {
            point.points.push_back(object_);
        } else {
            const auto place = place_of(fields);
            if (!place) return pass_on(place);
            point.points.push_back(*place);
        }
        const std::size_t text = name == "Text" ? 3 : 2;
        if (name != "Icon" && fields.size() > text) point.label = shape_label(fields[text]);
        taken.shapes.push_back(std::move(point));
        return {};
    }

    Status take_object(std::string_view value) {
        const auto place = place_of(fields_of(value));
        if (!place) return pass_on(place);
        object_ = *place;
        return {};
    }

    Status take_place_line(std::string_view line) {
        if (block_ == Block::none) return fail(ErrorCode::corrupt, "it is no statement");
        if (block_ != Block::line || is_in_inner_block_) return {};
        const auto place = place_of(fields_of(trimmed(line.substr(0, line.find(';')))));
        if (!place) return pass_on(place);
        shape_.points.push_back(*place);
        // A polygon may have several contours. Each ends where it begins.
        const bool is_contour = is_area_ && shape_.points.size() > 2 &&
                                is_same_place(shape_.points.front(), shape_.points.back());
        if (is_contour) end_line();
        return {};
    }

    static bool is_same_place(grid::GeoPoint a, grid::GeoPoint b) {
        return a.latitude_deg == b.latitude_deg && a.longitude_deg == b.longitude_deg;
    }

    // Adds the line, and begins another line like it.
    void end_line() {
        OverlayShape next = shape_;
        next.points.clear();
        const bool is_open = is_area_ && shape_.points.size() > 1 &&
                             !is_same_place(shape_.points.front(), shape_.points.back());
        if (is_open) shape_.points.push_back(shape_.points.front());
        if (shape_.points.size() > 1) taken.shapes.push_back(std::move(shape_));
        shape_ = std::move(next);
    }

    void end_block() {
        if (block_ == Block::line) end_line();
        block_ = Block::none;
    }

    std::size_t number_ = 0, statements_ = 0, points_ = 0;
    Block block_ = Block::none;
    bool is_in_inner_block_ = false;  // a block in an Object, whose places are pixels
    bool is_area_ = false;
    OverlayShape style_, shape_;
    grid::GeoPoint object_;
};

}  // namespace

Result<ShapeOverlay> shapes_of_placefile(std::string_view text) {
    PlacefileReader reader;
    if (Status read = reader.read(text); !read) return pass_on(read);
    return std::move(reader.taken);
}

}  // namespace stormcellar::render
