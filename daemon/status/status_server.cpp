#include "daemon/status/status_server.h"

#include <algorithm>
#include <array>
#include <exception>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <sched.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "base/printable.h"
#include "daemon/log/log.h"
#include "daemon/process/main_loop.h"
#include "daemon/status/http_listener.h"
#include "daemon/status/metrics_text.h"
#include "daemon/status/status_json.h"
#include "service/http_daemon.h"
#include "service/signals.h"

namespace stormcellar::daemon {
namespace {

HttpResponse response_of(std::string_view text, const char* type) {
    std::string copy{text};
    HttpResponse response(
        MHD_create_response_from_buffer(copy.size(), copy.data(), MHD_RESPMEM_MUST_COPY));
    if (response) {
        MHD_add_response_header(response.get(), MHD_HTTP_HEADER_CONTENT_TYPE, type);
        MHD_add_response_header(response.get(), MHD_HTTP_HEADER_CONNECTION, "close");
        MHD_add_response_header(response.get(), MHD_HTTP_HEADER_CACHE_CONTROL, "no-store");
        MHD_add_response_header(response.get(), MHD_HTTP_HEADER_X_CONTENT_TYPE_OPTIONS, "nosniff");
    }
    return response;
}

constexpr const char* plain = "text/plain; charset=utf-8";

// Gives this thread, which creates only the socket, a umask of its own. The umask of the service is
// meant for files, and would keep the group from using the socket. If the system refuses, the
// service's umask applies; then Worker::open() reports that the group cannot use the socket.
void take_own_umask() {
    if (::unshare(CLONE_FS) == 0) ::umask(0117);
}

void warn_if_narrow(const std::string& name, mode_t mode) {
    constexpr mode_t group_may_ask = 0060;
    if ((mode & group_may_ask) == group_may_ask) return;
    log_warning({Event::status_unanswered},
                "the umask keeps the group from reading the status: {} has mode {:04o}; start the "
                "service with umask 0007",
                printable(name), mode);
}

}  // namespace

// The members that only the server's thread uses.
class StatusServer::Worker {
  public:
    Worker(StatusServerOptions options, Render render);

    // Opens the addresses that should be open and are not open.
    void open(SteadyTime now);
    // Returns why an address is not served; empty if all addresses are served.
    [[nodiscard]] std::string unanswered() const;
    void wait(SteadyTime now, const WakeUp& wake_up);
    void turn(SteadyTime now);

  private:
    struct Address {
        std::string name;
        std::function<Result<ListeningSocket>()> listen;
        bool may_lack = false;  // a problem with this address is no error, for example without IPv6
        std::unique_ptr<HttpListener> listener = nullptr;
        bool failing = false;   // the last attempt failed, and that was logged
        bool hopeless = false;  // do not try again
        std::string problem = {};
    };
    struct Page {
        HttpResponse response;
        SteadyTime made{};
    };
    void open(Address& address);
    HttpListener::Answer answer(const HttpListener::Request& request) noexcept;
    HttpListener::Answer page(StatusPage which);

    StatusServerOptions options_;
    Render render_;
    std::array<Page, 2> pages_;
    HttpResponse not_found_ = response_of("GET /metrics or /status.json\n", plain);
    HttpResponse not_allowed_ = response_of("GET only\n", plain);
    HttpResponse not_here_ =
        response_of("ask for 127.0.0.1, localhost or [::1], with this port or none\n", plain);
    HttpResponse not_yet_ = response_of("starting\n", plain);
    SteadyTime next_open_{};
    std::vector<Address> addresses_;  // the last member: its answers use the members above
};

StatusServer::Worker::Worker(StatusServerOptions options, Render render)
    : options_(std::move(options)), render_(std::move(render)) {
    MHD_add_response_header(not_allowed_.get(), MHD_HTTP_HEADER_ALLOW, "GET, HEAD");
    if (!options_.socket.empty()) {
        addresses_.push_back({options_.socket.native(),
                              [this] { return ListeningSocket::at_path(options_.socket); }});
    }
    if (options_.http_port == 0) return;
    for (const Loopback loopback : {Loopback::ipv4, Loopback::ipv6}) {
        const bool is_new = loopback == Loopback::ipv6;
        addresses_.push_back(
            {fmt::format("http://{}:{}", is_new ? "[::1]" : "127.0.0.1", options_.http_port),
             [this, loopback] { return ListeningSocket::at_port(loopback, options_.http_port); },
             is_new});
    }
}

void StatusServer::Worker::open(Address& address) {
    if (address.hopeless || (address.listener && address.listener->still_stands())) return;
    address.listener.reset();
    Result<ListeningSocket> socket = address.listen();
    Status opened = socket ? Status{} : Status{pass_on(socket)};
    if (socket) {
        if (!socket->port()) warn_if_narrow(address.name, socket->mode());
        auto listener = HttpListener::open(
            std::move(*socket), {options_.longest_connection, options_.most_connections},
            [this](const HttpListener::Request& request) { return answer(request); });
        if (listener) {
            address.listener = std::move(*listener);
        } else {
            opened = pass_on(listener);
        }
    }
    if (opened) {
        log_info({Event::status_answered}, "status and metrics can be read at {}",
                 printable(address.name));
    } else if (!address.failing) {
        address.hopeless = opened.error().code == ErrorCode::bad_argument;
        log_line(
            address.may_lack ? LogLevel::debug : LogLevel::error,
            {.event = Event::status_unanswered, .reason = name_of(opened.error().code)},
            fmt::format(
                "the status cannot be served: {}; {}", printable(opened.error().message),
                address.hopeless ? "name another [status] socket and restart" : "trying again"));
    }
    address.failing = !opened;
    address.problem = opened ? std::string{} : opened.error().message;
}

std::string StatusServer::Worker::unanswered() const {
    for (const Address& address : addresses_) {
        if (address.may_lack || address.hopeless) continue;
        if (address.listener && address.problem.empty()) continue;
        return fmt::format("the status cannot be served: {}", address.problem);
    }
    return {};
}

void StatusServer::Worker::open(SteadyTime now) {
    if (now < next_open_) return;
    next_open_ = now + options_.retry;
    for (Address& address : addresses_)
        open(address);
}

void StatusServer::Worker::wait(SteadyTime now, const WakeUp& wake_up) {
    SteadyTime next = next_open_;
    std::vector<pollfd> sources = {{wake_up.descriptor(), POLLIN, 0}};
    for (const Address& address : addresses_) {
        if (!address.listener) continue;
        sources.push_back({address.listener->descriptor(), POLLIN, 0});
        if (const auto due = address.listener->next_time(now)) next = std::min(next, *due);
    }
    poll_until(sources, now, next);
}

void StatusServer::Worker::turn(SteadyTime now) {
    for (Address& address : addresses_)
        if (address.listener) address.listener->turn(now);
}

HttpListener::Answer StatusServer::Worker::page(StatusPage which) {
    Page& page = pages_.at(static_cast<std::size_t>(which));
    const SteadyTime now = std::chrono::steady_clock::now();
    if (!page.response || now - page.made >= options_.freshness) {
        const std::string text = render_(which);
        if (text.empty()) return {not_yet_.get(), MHD_HTTP_SERVICE_UNAVAILABLE};
        page.response = response_of(
            text, which == StatusPage::json ? "application/json" : metrics_content_type.data());
        page.made = now;
    }
    return {page.response.get(), MHD_HTTP_OK};
}

HttpListener::Answer StatusServer::Worker::answer(const HttpListener::Request& request) noexcept {
    try {
        if (request.names_another_host) return {not_here_.get(), MHD_HTTP_MISDIRECTED_REQUEST};
        const std::string_view word = request.method;
        if (word != MHD_HTTP_METHOD_GET && word != MHD_HTTP_METHOD_HEAD)
            return {not_allowed_.get(), MHD_HTTP_METHOD_NOT_ALLOWED};
        const std::string_view path = request.url;
        if (path == "/metrics") return page(StatusPage::metrics);
        if (path == "/status.json") return page(StatusPage::json);
        return {not_found_.get(), MHD_HTTP_NOT_FOUND};
    } catch (const std::exception&) {  // out of memory: the client may ask again
        return {};
    }
}

StatusServer::StatusServer(StatusServerOptions options, Render render)
    : worker_(std::make_unique<Worker>(std::move(options), std::move(render))),
      thread_([this] { run(); }) {}

StatusServer::~StatusServer() {
    stopping_ = true;
    wake_up_.set();
    thread_.join();
}

void StatusServer::run() {
    // A write to a client that is gone must fail, and must not end the process.
    const BlockedSignals blocked({SIGPIPE});
    // On Linux this sets the priority of this thread only. If the system refuses, the priority
    // stays.
    (void)::setpriority(PRIO_PROCESS, 0, 10);
    take_own_umask();
    while (!stopping_) {
        {
            const AtWork at_work(pulse_);
            worker_->turn(std::chrono::steady_clock::now());
            worker_->open(std::chrono::steady_clock::now());
            const MutexLock lock(unanswered_mutex_);
            unanswered_ = worker_->unanswered();
        }
        worker_->wait(std::chrono::steady_clock::now(), wake_up_);
    }
}

Status StatusServer::answers() const {
    const MutexLock lock(unanswered_mutex_);
    if (unanswered_.empty()) return {};
    return fail(ErrorCode::io, "{}", unanswered_);
}

StatusServer::Render pages_of(const StatusBoard& board) {
    return [&board](StatusPage which) -> std::string {
        const auto snapshot = board.latest();
        if (!snapshot) return {};
        return (which == StatusPage::json ? status_json : metrics_text)(
            snapshot->facts, snapshot->pending, now_utc());
    };
}

}  // namespace stormcellar::daemon
