#include "render/options/picture_options.h"

#include <algorithm>

#include <fmt/ranges.h>

#include "stormcellar/render/product.h"

namespace stormcellar::render {
namespace {

// Completes the help of an option. Writes the ends of the option's range, or its possible texts,
// into the help.
struct HelpOf {
    std::string help;
    std::string operator()(const WholeValue& value) const { return with(value.range); }
    std::string operator()(const NumberValue& value) const { return with(value.range); }
    std::string operator()(const TextValue& value) const {
        return value.known == nullptr ? help : fmt::format(fmt::runtime(help), value.known());
    }
    template <class Other>
    std::string operator()(const Other& /*value*/) const {
        return help;
    }
    [[nodiscard]] std::string with(NumberRange range) const {
        return fmt::format(fmt::runtime(help), range.least, range.most);
    }
};

}  // namespace

std::string ProductUse::text() const {
    if (only) return std::string(product_name(*only));
    if (with_threshold || hail) {
        std::vector<std::string_view> names;
        for (const ProductFacts& facts : all_products()) {
            if (includes(facts.product)) names.push_back(facts.name);
        }
        return fmt::format("{}", fmt::join(names, ", "));
    }
    if (maps) return "maps";
    if (!all_but) return "any product";
    return fmt::format("any product but {}", product_name(*all_but));
}

std::string_view parameter_of(const PictureOption& option) {
    return option.option.substr(std::string_view("--").size());
}

std::string key_of(const PictureOption& option) {
    return fmt::format("[{}] {}", option.section, option.key);
}

std::string help_of(const PictureOption& option) {
    return std::visit(HelpOf{std::string(option.help)}, option.value);
}

bool contains(const ChosenOptions& chosen, const PictureOption& option) {
    return std::ranges::find(chosen, &option) != chosen.end();
}

}  // namespace stormcellar::render
