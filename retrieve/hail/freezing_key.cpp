#include "retrieve/hail/freezing_key.h"

namespace stormcellar::retrieve {

void read_freezing_levels(TomlTable& table, FreezingLevels& levels) {
    constexpr std::string_view key = "freezing_levels_m";
    const auto heights_m = table.numbers(key);
    if (!heights_m) return;
    if (heights_m->size() != 2)
        return table.complain(key, "must be two heights, as in [4200, 7300]");
    levels = {(*heights_m)[0], (*heights_m)[1]};
    if (const auto valid = validate(levels); !valid) table.complain(key, valid.error().message);
}

}  // namespace stormcellar::retrieve
