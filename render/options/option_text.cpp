#include "render/options/option_text.h"

#include <cmath>

#include "base/floating_point.h"
#include "base/number_list.h"
#include "base/printable.h"
#include "render/options/scene_options.h"

namespace stormcellar::render {
namespace {

Status under_name(const std::string& option, const Status& status) {
    if (status) return {};
    return fail(status.error().code, "{}: {}", option, status.error().message);
}

Status check_places(std::span<const NumberPlace> places, const std::vector<double>& numbers) {
    for (std::size_t i = 0; i < places.size(); ++i) {
        const NumberRange range = places[i].range;
        if (is_within(numbers[i], range.least, range.most)) continue;
        return fail(ErrorCode::bad_argument, "{} must be {} to {}, not {}", places[i].name,
                    range.least, range.most, numbers[i]);
    }
    return {};
}

}  // namespace

Result<std::vector<double>> numbers_of(const std::string& option, const std::string& text,
                                       std::size_t count) {
    auto numbers = parse_numbers(text, ',');
    if (numbers && numbers->size() == count) return std::move(*numbers);
    return fail(ErrorCode::bad_argument, "{} needs {} numbers separated by commas, not '{}'",
                option, count, text);
}

Status take_text(const NumbersValue& value, const std::string& option, const std::string& text,
                 PictureSettings to) {
    const auto numbers = value.read != nullptr ? value.read(option, text)
                                               : numbers_of(option, text, value.places.size());
    if (!numbers) return pass_on(numbers);
    value.set(to, *numbers);
    return under_name(option, check_places(value.places, *numbers));
}

Status take_text(const TextValue& value, const std::string& option, const std::string& text,
                 PictureSettings to) {
    *value.field(to) = text;
    return under_name(option, value.check(text));
}

Status take_text(const NamesValue& value, const std::string& option, const std::string& text,
                 PictureSettings to) {
    return under_name(option, value.set(to, text));
}

Status take_text(const NumberValue& value, const std::string& option, const std::string& text,
                 PictureSettings to) {
    const auto number = numbers_of(option, text, 1);
    if (!number)
        return fail(ErrorCode::bad_argument, "{}: '{}' is no number", option, printable(text));
    *value.field(to) = number->front() * value.unit;
    return {};
}

Status take_text(const WholeValue& value, const std::string& option, const std::string& text,
                 PictureSettings to) {
    const auto number = numbers_of(option, text, 1);
    const bool is_whole = number && is_within(number->front(), -1e9, 1e9) &&
                          number->front() == std::floor(number->front());
    if (!is_whole) {
        return fail(ErrorCode::bad_argument, "{}: '{}' is no whole number", option,
                    printable(text));
    }
    *value.field(to) = static_cast<int>(number->front());
    return {};
}

Status take_text(const FlagValue& value, const std::string& option, const std::string& text,
                 PictureSettings to) {
    const bool is_set = text.empty() || text == "1" || text == "true";
    if (!is_set && text != "0" && text != "false") {
        return fail(ErrorCode::bad_argument, "{}: must be true or false, not '{}'", option,
                    printable(text));
    }
    *value.field(to) = is_set;
    return {};
}

}  // namespace stormcellar::render
