#include "cli/query/status_source.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/ranges.h>
#include <grp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "cli/shared/service_places.h"
#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/file_system.h"

namespace stormcellar::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds longest_wait{5};
constexpr std::size_t most_bytes = std::size_t{16} << 20;
constexpr const char* usual_runtime = "/run/stormcellar";
constexpr const char* socket_name = "status.sock";
constexpr const char* file_name = "status.json";
constexpr const char* loops_file_name = "loops/status.json";
constexpr std::string_view request = "GET /status.json HTTP/1.0\r\n\r\n";

Error system_error(const fs::path& path, int error_number) {
    return {ErrorCode::io,
            fmt::format("{}: {}", path.native(), std::system_category().message(error_number))};
}

// Waits until the descriptor is ready. Returns false if `end` comes first.
bool wait_for(int descriptor, short what, Clock::time_point end) {
    while (true) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()).count();
        pollfd source{descriptor, what, 0};
        const int ready = ::poll(&source, 1, static_cast<int>(std::max<std::int64_t>(0, left)));
        if (ready > 0) return true;
        if (ready == 0 || errno != EINTR) return false;
    }
}

Result<std::string> read_answer(const Descriptor& socket, const fs::path& path,
                                Clock::time_point end) {
    std::string answer;
    std::array<char, 65536> buffer{};
    while (answer.size() <= most_bytes) {
        if (!wait_for(socket.number(), POLLIN, end))
            return fail(ErrorCode::io, "{}: the daemon did not answer within {} s", path.native(),
                        longest_wait.count());
        const ssize_t got = ::read(socket.number(), buffer.data(), buffer.size());
        if (got < 0 && (errno == EINTR || errno == EAGAIN)) continue;
        if (got < 0) return tl::unexpected(system_error(path, errno));
        if (got == 0) return answer;
        answer.append(buffer.data(), static_cast<std::size_t>(got));
    }
    return fail(ErrorCode::corrupt, "{}: the answer of the daemon is too long", path.native());
}

// Parses the text. Returns none if it is not a JSON object.
std::optional<nlohmann::json> parse_object(std::string_view text) {
    auto document = nlohmann::json::parse(text, nullptr, false);
    if (!document.is_object()) return std::nullopt;
    return document;
}

std::optional<nlohmann::json> read_status_file(const fs::path& file) {
    if (file.empty()) return std::nullopt;
    const auto bytes = read_file(file, most_bytes);
    if (!bytes) return std::nullopt;
    return parse_object({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
}

// Returns those entries of the status document's list of loops that are objects.
std::vector<nlohmann::json> each_loop(const nlohmann::json& document) {
    std::vector<nlohmann::json> loops;
    const auto all = document.find("loops");
    if (all == document.end() || !all->is_object()) return loops;
    const auto each = all->find("each");
    if (each == all->end() || !each->is_array()) return loops;
    std::copy_if(each->begin(), each->end(), std::back_inserter(loops),
                 [](const nlohmann::json& loop) { return loop.is_object(); });
    return loops;
}

// Returns true if the daemon says that another process runs its loops.
bool are_elsewhere(const nlohmann::json& document) {
    const auto& loops = document.at("loops");
    return loops.contains("elsewhere") && loops["elsewhere"] == true;
}

// Returns true if the process exists, even if it belongs to another user, so that we may not signal
// it.
bool is_alive(const nlohmann::json& keeper) {
    const auto pid = keeper.find("pid");
    return pid != keeper.end() && pid->is_number_integer() && pid->get<std::int64_t>() > 0 &&
           (::kill(pid->get<pid_t>(), 0) == 0 || errno != ESRCH);
}

// Marks the loops as stopped. Their process was killed, so its last report is no longer true.
void stop_all(nlohmann::json& loops) {
    loops["running"] = 0;
    if (!loops.contains("each") || !loops["each"].is_array()) return;
    for (nlohmann::json& loop : loops["each"])
        if (loop.is_object()) loop["running"] = false;
}

// Adds the configured loops that the document does not list, for example because their process has
// ended.
void add_those_that_lack(nlohmann::json& loops, const std::vector<nlohmann::json>& configured) {
    nlohmann::json& each = loops["each"];
    if (!each.is_array()) each = nlohmann::json::array();
    const auto has = [&](const nlohmann::json& name) {
        return std::any_of(each.begin(), each.end(), [&](const nlohmann::json& loop) {
            return loop.is_object() && loop.contains("name") && loop["name"] == name;
        });
    };
    for (const nlohmann::json& loop : configured)
        if (loop.contains("name") && !has(loop["name"])) each.push_back(loop);
}

// Appends the socket that the status file names, unless the list already has it.
void add_named_socket(StatusPlaces& places) {
    const auto document = read_status_file(places.file);
    if (!document) return;
    const auto listening = document->find("listening");
    if (listening == document->end() || !listening->is_object()) return;
    const auto socket = listening->find("socket");
    if (socket == listening->end() || !socket->is_string()) return;
    const fs::path named = socket->get<std::string>();
    if (std::find(places.sockets.begin(), places.sockets.end(), named) == places.sockets.end())
        places.sockets.push_back(named);
}

StatusPlaces places_in(const ServicePlaces& service) {
    StatusPlaces places{{}, service.state / file_name, service.state / loops_file_name};
    if (service.socket) {
        places.sockets = {*service.socket};
        return places;
    }
    places.sockets = {service.state / socket_name};
    // With the usual state directory, the daemon is probably run by systemd, whose socket comes
    // first.
    if (service.state == usual_state) {
        places.sockets.insert(places.sockets.begin(), fs::path{usual_runtime} / socket_name);
    }
    add_named_socket(places);
    return places;
}

}  // namespace

Result<StatusPlaces> places_of(const StatusOptions& options) {
    if (!options.socket.empty()) return StatusPlaces{{options.socket}, {}, {}};
    if (options.state.empty()) {
        const auto service = service_places(options.config);
        if (!service) return pass_on(service);
        if (*service) return places_in(**service);
    }
    StatusPlaces places;
    const fs::path state = options.state.empty() ? usual_state : options.state;
    if (options.state.empty()) places.sockets.push_back(fs::path{usual_runtime} / socket_name);
    places.sockets.push_back(state / socket_name);
    places.file = state / file_name;
    places.loops = state / loops_file_name;
    add_named_socket(places);
    return places;
}

void add_loops(nlohmann::json& document, const fs::path& loops) {
    const std::vector<nlohmann::json> configured = each_loop(document);
    if (!configured.empty() && !are_elsewhere(document)) return;
    const auto keeper = read_status_file(loops);
    if (!keeper || !keeper->contains("loops")) return;
    document["loops"] = (*keeper)["loops"];
    auto& service = document["loops_service"] = nlohmann::json::object();
    for (const char* key : {"state", "pid", "version", "started", "updated"})
        if (keeper->contains(key)) service[key] = (*keeper)[key];
    const bool alive = is_alive(*keeper);
    service["alive"] = alive;
    if (!document["loops"].is_object()) return;
    if (!alive) stop_all(document["loops"]);
    add_those_that_lack(document["loops"], configured);
}

std::string how_to_be_let_in(const fs::path& socket) {
    struct stat found {};
    if (::stat(socket.c_str(), &found) != 0) return "";
    const struct group* known = ::getgrgid(found.st_gid);  // safe, because there is only one thread
    if (known == nullptr) return "";
    return fmt::format(
        "; only members of the group {0} may ask: run sudo usermod -aG {0} USER, then log in again",
        known->gr_name);
}

Result<nlohmann::json> ask_socket(const fs::path& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.native().size() >= sizeof address.sun_path)
        return fail(ErrorCode::io, "{}: the path is too long for a socket", path.native());
    std::memcpy(static_cast<char*>(address.sun_path), path.c_str(), path.native().size());
    const Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    if (socket.number() < 0) return tl::unexpected(system_error(path, errno));
    if (::connect(socket.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) !=
        0) {
        const int error_number = errno;
        Error refused = system_error(path, error_number);
        if (error_number == EACCES) refused.message += how_to_be_let_in(path);
        return tl::unexpected(refused);
    }
    const auto end = Clock::now() + longest_wait;
    if (!wait_for(socket.number(), POLLOUT, end) ||
        ::send(socket.number(), request.data(), request.size(), MSG_NOSIGNAL) !=
            static_cast<ssize_t>(request.size())) {
        return fail(ErrorCode::io, "{}: the daemon does not accept the question", path.native());
    }
    const auto answer = read_answer(socket, path, end);
    if (!answer) return pass_on(answer);
    const std::string_view text = *answer;
    if (text.find(" 503 ") < text.find("\r\n"))
        return fail(ErrorCode::io, "{}: the daemon is still starting", path.native());
    const auto headers = text.find("\r\n\r\n");
    const auto document =
        headers == std::string_view::npos ? std::nullopt : parse_object(text.substr(headers + 4));
    if (!document)
        return fail(ErrorCode::corrupt, "{}: the answer is not a daemon's status", path.native());
    return *document;
}

Result<StatusAnswer> find_status(const StatusPlaces& places) {
    std::vector<std::string> reasons;
    for (const fs::path& socket : places.sockets) {
        auto document = ask_socket(socket);
        if (document) return StatusAnswer{std::move(*document), socket, {}};
        reasons.push_back(document.error().message);
    }
    const std::string why = fmt::format("{}", fmt::join(reasons, "; "));
    if (auto document = read_status_file(places.file))
        return StatusAnswer{std::move(*document), places.file, why};
    if (!places.file.empty()) {
        return fail(ErrorCode::not_found, "no daemon answers ({}), and {} holds no status", why,
                    places.file.native());
    }
    return fail(ErrorCode::not_found, "no daemon answers ({})", why);
}

}  // namespace stormcellar::cli
