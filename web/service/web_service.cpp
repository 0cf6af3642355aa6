#include "web/service/web_service.h"

#include <algorithm>
#include <exception>
#include <functional>
#include <set>
#include <thread>
#include <utility>

#include <fmt/ranges.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "base/steady_time.h"
#include "service/log.h"
#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/mutex.h"

namespace stormcellar::web {
namespace {

// Returns true if [::1] can be used. The shipped configuration names it, but IPv6 may be off on
// this machine.
bool has_ipv6_loopback() {
    const Descriptor socket{::socket(AF_INET6, SOCK_STREAM | SOCK_CLOEXEC, 0)};
    if (!socket.is_open()) return false;
    sockaddr_in6 address{};
    address.sin6_family = AF_INET6;
    address.sin6_addr = in6addr_loopback;
    return ::bind(socket.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) ==
           0;
}

unsigned workers_of(const WebLimits& limits) {
    if (limits.workers > 0) return static_cast<unsigned>(limits.workers);
    return 2 * std::max(1U, std::thread::hardware_concurrency());
}

void note_answer(const Served& served) {
    if (!is_logged(LogLevel::debug) || served.request == nullptr) return;
    say(LogLevel::debug, "{} {} {} bytes in {:.1f} ms for {}", served.status, served.request->path,
        served.bytes, served.seconds.count() * 1000, served.request->client);
}

// Logs failures of answers. Clients can repeat requests, so it logs the same text only once a
// minute, and only a few texts.
class TroubleLog {
  public:
    void note(const Served& served) {
        const MutexLock lock(mutex_);
        const SteadyTime now = steady_now();
        if (now - began_ > std::chrono::minutes{1}) {
            began_ = now;
            noted_.clear();
        }
        if (noted_.size() >= most_noted || !noted_.emplace(served.trouble).second) return;
        say(LogLevel::error, "{}: {}",
            served.request == nullptr ? "an answer" : std::string_view{served.request->path},
            served.trouble);
    }

  private:
    static constexpr std::size_t most_noted = 20;
    Mutex mutex_;
    SteadyTime began_ STORMCELLAR_GUARDED_BY(mutex_){};
    std::set<std::string, std::less<>> noted_ STORMCELLAR_GUARDED_BY(mutex_);
};

// Returns true if a held socket has the port of a wanted address that has no socket. For example, a
// socket at 127.0.0.1:80 prevents a socket at 0.0.0.0:80.
bool holds_a_port_of(const std::vector<ListenAddress>& wanted, const ListenSockets& held) {
    return std::ranges::any_of(held, [&](const ListenSocket& socket) {
        return std::ranges::any_of(wanted, [&](const ListenAddress& where) {
            return where.port == socket.port && where.address != socket.where.address;
        });
    });
}

}  // namespace

ServerOptions server_options_of(const WebConfig& config) {
    ServerOptions options;
    options.listen.clear();
    const bool lacks_ipv6 = config.listen.size() > 1 && !has_ipv6_loopback();
    for (const BindAddress& address : config.listen) {
        if (address.host == "::1" && lacks_ipv6) continue;
        options.listen.push_back({address.host, address.port});
    }
    options.names = config.names;
    options.trusted_proxies = config.trusted_proxies;
    options.origins = {config.cors, config.embed_in};
    if (config.public_address) {
        options.public_address = config.public_address->text();
        options.prefix = config.public_address->prefix;
        options.names.push_back(config.public_address->host());
    }
    const WebLimits& limits = config.limits;
    options.limits.most_connections = static_cast<unsigned>(limits.connections);
    options.limits.most_streams = static_cast<unsigned>(limits.event_streams);
    options.limits.most_connections_of_address =
        static_cast<unsigned>(limits.connections_of_an_address);
    options.limits.header_bytes = limits.header_bytes;
    options.limits.request_time = limits.request;
    options.limits.least_bytes_per_s = limits.least_bytes_per_second;
    options.limits.answer_bytes = limits.answer_bytes;
    options.limits.workers = workers_of(limits);
    // A connection has only one request at a time, so as many places as connections are enough for
    // the queue. Slow answers have limits of their own.
    options.limits.most_waiting = static_cast<std::size_t>(limits.connections);
    return options;
}

Result<std::unique_ptr<WebService>> WebService::open(WebSetup setup) {
    auto sources = open_sources(std::move(setup));
    if (!sources) return pass_on(sources);
    sources->numbers->remove_leftovers();
    std::unique_ptr<WebService> service(new WebService(std::move(*sources)));
    if (const Status served = service->serve(); !served) return pass_on(served);
    return service;
}

Status WebService::serve() try {
    const auto measures = std::make_shared<Measures>();
    ServerOptions options = server_options_of(sources_.setup.web);
    auto sockets = open_listen_sockets(options.listen, sockets_);
    if (!sockets) return pass_on(sockets);
    options.on_answer = [measures,
                         troubles = std::make_shared<TroubleLog>()](const Served& served) {
        measures->counters()->count(served);
        note_answer(served);
        if (!served.trouble.empty()) troubles->note(served);
    };
    auto server = Server::open(std::move(options), doors_to(sources_, *measures), *sockets);
    if (!server) return pass_on(server);
    measures->set_server(server->get());
    sockets_ = std::move(*sockets);
    // An earlier server ends here. The new server listens already, so that no client has to wait.
    server_ = std::move(*server);
    return {};
} catch (const std::exception& error) {
    return fail(ErrorCode::exhausted, "the server cannot begin: {}", error.what());
}

std::vector<std::string> WebService::addresses() const {
    return server_ ? server_->addresses() : std::vector<std::string>{};
}

bool WebService::is_at_work() const {
    if (!is_listening()) return false;
    (void)facts();
    return true;
}

void WebService::look_again() {
    if (!is_listening()) listen_again();
    look_for_catalog();
    note_numbers();
}

void WebService::listen_again() {
    if (const Status served = serve(); !served) return;
    say(LogLevel::info, "listening again on {}", fmt::join(addresses(), " "));
}

void WebService::look_for_catalog() {
    if (has_catalog() || sources_.setup.catalog.empty()) return;
    auto catalog = catalog::CatalogReader::open(sources_.setup.catalog);
    if (!catalog) return;
    say(LogLevel::info, "the catalog {} is there now", sources_.setup.catalog.native());
    if (const Status taken = reload(sources_.setup); !taken)
        say(LogLevel::error, "{}", taken.error().message);
}

void WebService::note_numbers() {
    const std::string problem = sources_.numbers->problem().value_or("");
    if (problem == problem_) return;
    problem_ = problem;
    if (problem.empty()) {
        say(LogLevel::info, "the numbers of times in Zarr arrays are kept again");
    } else {
        say(LogLevel::error, "Zarr arrays get no new times, since their numbers cannot be kept: {}",
            problem);
    }
}

Status WebService::reload(WebSetup fresh) {
    const WebSetup before = sources_.setup;
    fresh.drop = before.drop;
    fresh.state = before.state;
    fresh.catalog = before.catalog;
    fresh.cache = before.cache;
    fresh.numbers = before.numbers;
    fresh.added_stations = before.added_stations;
    // First do what can fail, while the old server goes on.
    auto sources = open_sources(std::move(fresh));
    if (!sources) return pass_on(sources);
    sources->numbers = sources_.numbers;
    const auto wanted = server_options_of(sources->setup.web).listen;
    auto sockets = open_listen_sockets(wanted, sockets_);
    if (!sockets) {
        const ErrorCode why = sockets.error().code;
        const bool may_help = why == ErrorCode::busy || why == ErrorCode::exhausted;
        if (!may_help || !holds_a_port_of(wanted, sockets_)) return pass_on(sockets);
        server_.reset();
        sockets_.clear();
        sockets.emplace();
    }
    ListenSockets held = std::exchange(sockets_, *std::move(sockets));
    std::swap(sources_, *sources);
    const Status served = serve();
    if (served) return {};
    std::swap(sources_, *sources);
    sockets_ = std::move(held);
    if (server_ != nullptr) return served;
    if (const Status again = serve(); !again) {
        say(LogLevel::error, "this server listens nowhere, and tries again each second: {}",
            again.error().message);
    }
    return served;
}

ServerFacts WebService::facts() const {
    return server_ ? server_->facts() : ServerFacts{};
}

}  // namespace stormcellar::web
