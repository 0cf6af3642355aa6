#include "web/doors/api/door.h"

#include <algorithm>
#include <set>

#include "web/doors/api/operations.h"

namespace stormcellar::web {
namespace {

using PathValues = std::vector<std::pair<std::string, std::string>>;

// Returns the values of the names in braces; none if the path does not match.
std::optional<PathValues> match(std::string_view path_template, std::string_view path) {
    const auto expected = segments_of(path_template);
    const auto segments = segments_of(path);
    if (expected.size() != segments.size()) return std::nullopt;
    PathValues values;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        if (expected[i].starts_with('{')) {
            values.emplace_back(expected[i].substr(1, expected[i].size() - 2), segments[i]);
        } else if (expected[i] != segments[i]) {
            return std::nullopt;
        }
    }
    return values;
}

struct Routed {
    const ApiOperation* operation = nullptr;
    PathValues values;
};
std::optional<Routed> route(const Request& request) {
    for (const ApiOperation& operation : api_operations()) {
        if (auto values = match(operation.path, request.path)) {
            return Routed{&operation, std::move(*values)};
        }
    }
    return std::nullopt;
}

// Refuses unknown parameters. Otherwise a misspelled parameter would have no effect.
Status check_parameters(const ApiOperation& operation, const Request& request) {
    std::set<std::string_view> seen;
    for (const auto& [name, value] : request.query) {
        const bool is_known = std::ranges::any_of(
            operation.parameters,
            [&, &text = name](const ApiParameter& known) { return known.name == text; });
        if (!is_known) {
            return fail(ErrorCode::bad_argument, "there is no parameter '{}' of {}",
                        name.substr(0, 40), operation.path);
        }
        if (!seen.insert(name).second) {
            return fail(ErrorCode::bad_argument, "{}: the parameter comes twice", name);
        }
    }
    return {};
}

}  // namespace

std::optional<Answer> ApiDoor::answer_at_once(const Request& request) {
    auto routed = route(request);
    if (!routed || routed->operation->answer_at_once == nullptr) return std::nullopt;
    if (!check_parameters(*routed->operation, request)) return std::nullopt;
    return routed->operation->answer_at_once({request, state_, std::move(routed->values), true});
}

std::optional<Answer> ApiDoor::answer_soon(const Request& request) {
    Answer answer = answer_of(request, true);
    if (answer.status == takes_long().status) return std::nullopt;
    return answer;
}

Answer ApiDoor::answer(const Request& request) {
    return answer_of(request, false);
}

Answer ApiDoor::answer_of(const Request& request, bool must_be_quick) {
    auto routed = route(request);
    if (!routed) {
        return json_error(404, "the API has no such path: /api/v1 lists those that there are");
    }
    if (Status good = check_parameters(*routed->operation, request); !good) {
        return json_error(good.error());
    }
    return routed->operation->answer({request, state_, std::move(routed->values), must_be_quick});
}

}  // namespace stormcellar::web
