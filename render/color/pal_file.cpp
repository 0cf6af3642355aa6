// Reads color tables of the GRLevelX programs (.pal).
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <vector>

#include "base/parse_number.h"
#include "base/printable.h"
#include "render/color/built_in_tables.h"
#include "render/color/color_file.h"
#include "render/color/pal_words.h"

namespace stormcellar::render {
namespace {

using level2::Moment;

constexpr std::size_t longest_word = 64;

struct Entry {
    double value = 0;
    Rgba8 color{};
    std::optional<Rgba8> until;
    bool solid = false;
};

std::string upper(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return out;
}

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == ',' || c == '\f';
}

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    std::size_t at = 0;
    while (at < line.size()) {
        if (is_space(line[at])) {
            ++at;
            continue;
        }
        std::size_t end = at;
        while (end < line.size() && !is_space(line[end]))
            ++end;
        words.push_back(line.substr(at, end - at));
        at = end;
    }
    return words;
}

// Returns the word in a form that can safely be shown in a message.
std::string shown(std::string_view word) {
    return printable(word.substr(0, longest_word));
}

std::optional<double> number_of(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    const auto number = parse_number<double>(word);
    const bool is_value =
        number && std::isfinite(*number) && std::abs(*number) <= greatest_color_value;
    return is_value ? number : std::nullopt;
}

class PalReader {
  public:
    explicit PalReader(const std::string& name) : name_(name) {}

    Status take_line(std::string_view line) {
        ++line_;
        if (const auto comment = line.find(';'); comment != std::string_view::npos) {
            line = line.substr(0, comment);
        }
        const auto words = words_of(line);
        if (words.empty() || words.front().starts_with('#')) return {};
        const auto colon = line.find(':');
        if (colon == std::string_view::npos)
            return refuse("'{}' is not followed by a colon, as in 'Key: value'", words.front());
        const auto key_words = words_of(line.substr(0, colon));
        if (key_words.size() != 1)
            return refuse("'{}' is not followed by a colon, as in 'Key: value'", words.front());
        return take(upper(key_words.front()), words_of(line.substr(colon + 1)));
    }

    Result<ColorTable> finish() {
        if (entries_.empty()) {
            return fail(ErrorCode::bad_argument,
                        "{}:{}: the file has no Color: or SolidColor:", name_, line_);
        }
        ColorTable table;
        const double per_ours = settle_meaning(table);
        settle_order();
        make_stops(table, per_ours);
        const float lowest = table.lowest();
        const float last = table.stops.back().from;
        const double step = step_ ? *step_ / per_ours : 0;
        float length = static_cast<float>(step);
        if (length <= 0) length = table.stops.size() > 1 ? last - table.stops.rbegin()[1].from : 1;
        table.end = last + length;
        if (!(table.end > last)) table.end = std::nextafter(last, 2e9F);
        table.range_folded = folded_.value_or(usual_range_folded);
        table.extinction = extinction_of_colors(table, moment_known_);
        if (auto valid = validate(table); !valid) {
            return fail(ErrorCode::bad_argument, "{}:{}: the table {} (lowest {})", name_, line_,
                        valid.error().message, lowest);
        }
        return table;
    }

  private:
    template <class... Args>
    [[nodiscard]] tl::unexpected<Error> refuse(fmt::format_string<Args...> format,
                                               const Args&... args) const {
        return fail(ErrorCode::bad_argument, "{}:{}: {}", name_, line_,
                    fmt::vformat(format, fmt::make_format_args(args...)));
    }

    using Words = std::vector<std::string_view>;

    Status take(const std::string& key, const Words& words) {
        if (key == "COLOR" || key == "COLOUR") return take_entry(words, 3, false);
        if (key == "COLOR4" || key == "COLOUR4") return take_entry(words, 4, false);
        if (key == "SOLIDCOLOR" || key == "SOLIDCOLOUR") return take_entry(words, 3, true);
        if (key == "SOLIDCOLOR4" || key == "SOLIDCOLOUR4") return take_entry(words, 4, true);
        if (key == "SCALE") return take_number(words, scale_, true);
        if (key == "OFFSET") return take_number(words, offset_, false);
        if (key == "STEP") return take_number(words, step_, true);
        if (key == "RF") return take_color(words, &folded_);
        if (key == "ND") return take_color(words, nullptr);
        if (key == "PRODUCT") return take_word(words, product_);
        if (key == "UNITS" || key == "UNIT") return take_word(words, unit_);
        if (key == "DECIMALS" || key == "CATEGORY" || key == "TITLE" || key == "NAME") return {};
        return refuse(
            "unknown key '{}'; the known keys are Product, Units, Scale, Offset, Step, RF, ND, "
            "Color, Color4, SolidColor, SolidColor4",
            shown(key));
    }

    Status take_word(const Words& words, std::string& word) {
        word = words.empty() ? std::string{} : shown(words.front());
        return {};
    }

    Status take_number(const Words& words, std::optional<double>& number, bool above_zero) {
        if (words.size() != 1)
            return refuse("there must be one number, not {} words", words.size());
        number = number_of(words.front());
        if (!number) return refuse("'{}' is not a number up to a million", shown(words.front()));
        if (above_zero && *number < 1e-9) return refuse("the number must be above 0");
        return {};
    }

    Result<Rgba8> color_from(const Words& words, std::size_t first, std::size_t channels) {
        Rgba8 color = {0, 0, 0, 255};
        for (std::size_t c = 0; c < channels; ++c) {
            const auto number = number_of(words[first + c]);
            if (!number || *number < 0 || *number > 255) {
                return refuse("'{}' is not a color; red, green, blue and alpha are 0 to 255",
                              shown(words[first + c]));
            }
            color[c] = static_cast<std::uint8_t>(std::lround(*number));
        }
        return color;
    }

    Status take_color(const Words& words, std::optional<Rgba8>* color) {
        if (words.size() < 3 || words.size() > 4) {
            return refuse("there must be red, green and blue, not {} numbers", words.size());
        }
        const auto read = color_from(words, 0, words.size());
        if (!read) return pass_on(read);
        if (color != nullptr) *color = *read;
        return {};
    }

    Status take_entry(const Words& words, std::size_t channels, bool solid) {
        if (words.size() != 1 + channels && words.size() != 1 + 2 * channels) {
            return refuse(
                "there must be a value and {} or {} numbers of color, not {} numbers in all",
                channels, 2 * channels, words.size());
        }
        if (entries_.size() == most_stops)
            return refuse("there are more than {} colors", most_stops);
        Entry entry;
        const auto value = number_of(words.front());
        if (!value) return refuse("'{}' is not a number up to a million", shown(words.front()));
        entry.value = *value;
        entry.solid = solid;
        const auto color = color_from(words, 1, channels);
        if (!color) return pass_on(color);
        entry.color = *color;
        if (words.size() > 1 + channels) {
            const auto until = color_from(words, 1 + channels, channels);
            if (!until) return pass_on(until);
            entry.until = *until;
        }
        entries_.push_back(entry);
        return {};
    }

    void note_moment(Moment moment, ColorTable& table) {
        moment_known_ = true;
        table.moment = moment;
        table.unit = unit_of(moment);
    }

    // Sets the moment and the unit of the table. Returns how many of the file's units make one of
    // our units.
    double settle_meaning(ColorTable& table) {
        const std::string product = upper(product_);
        if (const auto moment = level2::moment_from_name(product)) {
            note_moment(*moment, table);
        }
        for (const PalProduct& known : pal_products) {
            if (known.word != product) continue;
            if (known.moment) {
                note_moment(*known.moment, table);
            } else {
                table.unit = known.unit;
            }
        }
        double per_ours = 1;
        const std::string word = upper(unit_);
        const bool has_meaning = moment_known_ || !table.unit.empty();
        bool unit_known = false;
        for (const PalUnit& unit : pal_units) {
            if (unit.word != word) continue;
            unit_known = true;
            if (!has_meaning) {
                table.unit = unit.ours;
                moment_known_ = unit.ours == "dBZ" || unit.ours == "m/s";
                table.moment = unit.ours == "m/s" ? Moment::vel : Moment::ref;
            }
            if (unit.ours == table.unit) per_ours = unit.per_ours;
        }
        if (!has_meaning && !unit_known) table.unit = unit_;
        if (scale_) per_ours = *scale_;
        return per_ours;
    }

    // Sorts the entries by rising value, whether they rise or fall in the file. Entries with equal
    // values keep their order.
    void settle_order() {
        if (entries_.front().value > entries_.back().value) {
            std::reverse(entries_.begin(), entries_.end());
        }
        std::stable_sort(entries_.begin(), entries_.end(),
                         [](const Entry& a, const Entry& b) { return a.value < b.value; });
    }

    void make_stops(ColorTable& table, double per_ours) {
        const double offset = offset_.value_or(0);
        for (std::size_t i = 0; i < entries_.size(); ++i) {
            const Entry& entry = entries_[i];
            const auto from = static_cast<float>((entry.value - offset) / per_ours);
            Rgba8 until = entry.color;
            if (!entry.solid) {
                if (entry.until) {
                    until = *entry.until;
                } else if (i + 1 < entries_.size()) {
                    until = entries_[i + 1].color;
                }
            }
            if (!table.stops.empty() && table.stops.back().from >= from) {
                table.stops.back() = {table.stops.back().from, entry.color, until};
            } else {
                table.stops.push_back({from, entry.color, until});
            }
        }
    }

    const std::string& name_;
    std::size_t line_ = 0;
    std::vector<Entry> entries_;
    std::optional<double> scale_, offset_, step_;
    std::optional<Rgba8> folded_;
    std::string product_, unit_;
    bool moment_known_ = false;
};

}  // namespace

Result<ColorTable> parse_pal(std::string_view text, const std::string& name) {
    PalReader reader(name);
    while (!text.empty()) {
        const auto end = text.find('\n');
        if (auto taken = reader.take_line(text.substr(0, end)); !taken) return pass_on(taken);
        if (end == std::string_view::npos) break;
        text.remove_prefix(end + 1);
    }
    return reader.finish();
}

}  // namespace stormcellar::render
