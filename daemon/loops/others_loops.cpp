#include "daemon/loops/others_loops.h"

#include <algorithm>
#include <cerrno>
#include <csignal>

#include <nlohmann/json.hpp>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::daemon {
namespace {

using Json = nlohmann::json;

constexpr std::size_t most_bytes = std::size_t{1} << 20;

// Sets the value from the key. Leaves the value unchanged if the key is missing or has the wrong
// type.
template <typename Value>
void take(const Json& object, const char* key, bool (Json::*is_wanted)() const noexcept,
          Value& value) {
    const auto found = object.find(key);
    if (found != object.end() && (*found.*is_wanted)()) value = found->get<Value>();
}

LoopState loop_of(const Json& object) {
    LoopState loop;
    take(object, "name", &Json::is_string, loop.name);
    take(object, "running", &Json::is_boolean, loop.is_running);
    take(object, "restarts", &Json::is_number_unsigned, loop.restarts);
    take(object, "made", &Json::is_number_unsigned, loop.made);
    take(object, "frames", &Json::is_number_unsigned, loop.frames);
    take(object, "last_problem", &Json::is_string, loop.last_problem);
    std::string last_made;
    take(object, "last_made", &Json::is_string, last_made);
    if (const auto time = parse_utc(last_made, UtcTime{})) loop.last_made = *time;
    return loop;
}

bool is_alive(const Json& document) {
    std::string state;
    pid_t process = 0;
    take(document, "state", &Json::is_string, state);
    take(document, "pid", &Json::is_number_unsigned, process);
    return state == "running" && process > 0 && (::kill(process, 0) == 0 || errno != ESRCH);
}

}  // namespace

std::vector<LoopState> loops_of(std::string_view document) {
    const Json parsed = Json::parse(document, nullptr, false);
    if (!parsed.is_object()) return {};
    Json all = Json::object(), each = Json::array();
    take(parsed, "loops", &Json::is_object, all);
    take(all, "each", &Json::is_array, each);
    const bool alive = is_alive(parsed);
    std::vector<LoopState> loops;
    for (const Json& object : each) {
        if (!object.is_object()) continue;
        loops.push_back(loop_of(object));
        loops.back().is_running = loops.back().is_running && alive;
    }
    return loops;
}

std::vector<LoopState> others_loops(const std::filesystem::path& state,
                                    const std::vector<LoopConfig>& configured) {
    if (configured.empty()) return {};
    std::vector<LoopState> known;
    if (const auto bytes = read_file(state / "loops" / "status.json", most_bytes))
        known = loops_of({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
    std::vector<LoopState> loops;
    for (const LoopConfig& loop : configured) {
        const auto found = std::find_if(known.begin(), known.end(), [&](const LoopState& one) {
            return one.name == loop.name;
        });
        LoopState& shown = loops.emplace_back();
        if (found != known.end()) shown = *found;
        shown.name = loop.name;
    }
    return loops;
}

}  // namespace stormcellar::daemon
