#include "daemon/status/http_listener.h"

#include <algorithm>
#include <utility>

#include <strings.h>
#include <sys/socket.h>

#include "base/host_field.h"
#include "service/http_daemon.h"

namespace stormcellar::daemon {
namespace {

// Memory for the line and the headers of a request, and for the headers of its answer.
constexpr std::size_t request_memory = 8192;

// Checks every Host field of a request, because a client that sends two fields may mean either of
// the two.
MHD_Result look_at_host(void* are_ours, MHD_ValueKind, const char* name, const char* value) {
    if (name != nullptr && ::strcasecmp(name, MHD_HTTP_HEADER_HOST) == 0 &&
        !is_loopback_host(value == nullptr ? "" : value)) {
        *static_cast<bool*>(are_ours) = false;
    }
    return MHD_YES;
}

bool names_another_host(MHD_Connection* connection, std::optional<int> port) {
    if (!port) return false;  // web pages cannot open a Unix socket
    bool are_ours = true;
    MHD_get_connection_values(connection, MHD_HEADER_KIND, &look_at_host, &are_ours);
    return !are_ours;
}

}  // namespace

// The callbacks of libmicrohttpd, which are always called from within turn() or the destructor.
struct HttpListener::Callbacks {
    static MHD_Result answer(void* self, MHD_Connection* connection, const char* url,
                             const char* method, const char* /*version*/, const char* /*data*/,
                             std::size_t* /*data_size*/, void** /*of_request*/) {
        auto* listener = static_cast<HttpListener*>(self);
        const Answer answer = listener->answerer_(
            {method, url, names_another_host(connection, listener->socket_.port())});
        if (answer.response == nullptr) return MHD_NO;
        return MHD_queue_response(connection, answer.status, answer.response);
    }

    static void connection(void* self, MHD_Connection* connection, void** /*of_connection*/,
                           MHD_ConnectionNotificationCode what) {
        auto* listener = static_cast<HttpListener*>(self);
        ++listener->changes_;
        if (what == MHD_CONNECTION_NOTIFY_CLOSED) {
            listener->open_.erase(connection);
            return;
        }
        const auto* info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
        if (info == nullptr) return;
        const SteadyTime ends =
            std::chrono::steady_clock::now() + listener->limits_.longest_connection;
        listener->make_room();
        listener->open_[connection] = {info->connect_fd, ends, false};
    }
};

HttpListener::HttpListener(ListeningSocket socket, Limits limits, Answerer answerer)
    : socket_(std::move(socket)), limits_(limits), answerer_(std::move(answerer)) {}

Result<std::unique_ptr<HttpListener>> HttpListener::open(ListeningSocket socket, Limits limits,
                                                         Answerer answerer) {
    std::unique_ptr<HttpListener> made(
        new HttpListener(std::move(socket), limits, std::move(answerer)));
    Result<MHD_Daemon*> daemon =
        start_http_daemon(made->socket_.descriptor(), {.flags = MHD_USE_EPOLL,
                                                       .most_connections = limits.most_connections,
                                                       .header_bytes = request_memory,
                                                       .self = made.get(),
                                                       .answer = &Callbacks::answer,
                                                       .connection = &Callbacks::connection});
    if (!daemon) return pass_on(daemon);
    made->daemon_ = *daemon;
    const auto* info = MHD_get_daemon_info(made->daemon_, MHD_DAEMON_INFO_EPOLL_FD);
    if (info == nullptr) return fail(ErrorCode::internal, "libmicrohttpd gives no descriptor");
    made->epoll_ = info->epoll_fd;
    return made;
}

HttpListener::~HttpListener() {
    if (daemon_ != nullptr) MHD_stop_daemon(daemon_);
}

std::optional<SteadyTime> HttpListener::next_time(SteadyTime now) const {
    if (is_behind_) return now;
    std::optional<SteadyTime> next;
    const auto take = [&](SteadyTime time) { next = next ? std::min(*next, time) : time; };
    MHD_UNSIGNED_LONG_LONG wait_ms = 0;
    if (MHD_get_timeout(daemon_, &wait_ms) == MHD_YES) {
        take(now + std::chrono::milliseconds{std::min<MHD_UNSIGNED_LONG_LONG>(wait_ms, 60'000)});
    }
    for (const auto& [connection, open] : open_)
        if (!open.is_cut) take(open.ends);
    return next;
}

// Closes the oldest connection if three quarters of the allowed connections are open. Requests are
// answered at once, so the oldest connection has most likely sent no request yet.
void HttpListener::make_room() {
    const auto stands = [](const auto& one) { return !one.second.is_cut; };
    const auto standing = std::count_if(open_.begin(), open_.end(), stands);
    if (4 * standing < 3 * std::ptrdiff_t{limits_.most_connections}) return;
    auto oldest = open_.end();
    for (auto one = open_.begin(); one != open_.end(); ++one) {
        if (stands(*one) && (oldest == open_.end() || one->second.ends < oldest->second.ends))
            oldest = one;
    }
    if (oldest == open_.end()) return;
    ::shutdown(oldest->second.descriptor, SHUT_RDWR);
    oldest->second.is_cut = true;
}

void HttpListener::turn(SteadyTime now) {
    // Shut down connections whose time is over. libmicrohttpd notices that and closes them.
    for (auto& [connection, open] : open_) {
        if (open.is_cut || open.ends > now) continue;
        ::shutdown(open.descriptor, SHUT_RDWR);
        open.is_cut = true;
    }
    // A run of libmicrohttpd accepts only a few new connections, and none at the limit. Connections
    // that end in a run make room only for the next run, and no descriptor signals this room. So
    // run libmicrohttpd until nothing changes.
    is_behind_ = true;
    for (int round = 0; is_behind_ && round < most_rounds; ++round) {
        const std::uint64_t before = changes_;
        MHD_run(daemon_);
        is_behind_ = changes_ != before;
    }
}

}  // namespace stormcellar::daemon
