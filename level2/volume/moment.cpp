#include "stormcellar/level2/moment.h"

#include "base/name_list.h"

namespace stormcellar::level2 {

std::optional<Moment> moment_from_name(std::string_view name) {
    return key_named(moment_facts, &MomentFacts::moment, name);
}

std::string moment_names(std::string_view between, std::string_view before_last) {
    return names_in(moment_facts, between, before_last);
}

}  // namespace stormcellar::level2
