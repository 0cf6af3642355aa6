#include "web/http/server.h"

#include <atomic>
#include <cerrno>
#include <exception>
#include <set>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include "base/system_error.h"
#include "service/http_daemon.h"
#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/mutex.h"
#include "web/http/answer_budget.h"
#include "web/http/client_address.h"
#include "web/http/common_headers.h"
#include "web/http/connection_watch.h"
#include "web/http/read_request.h"
#include "web/http/response.h"
#include "web/http/work_queue.h"

namespace stormcellar::web {
namespace {

using SteadyClock = std::chrono::steady_clock;

// Adds a header. No exception may enter libmicrohttpd. If memory is short, drops all headers, which
// makes the request invalid.
MHD_Result take_header(void* headers, MHD_ValueKind, const char* name, const char* value) {
    auto& fields = *static_cast<Fields*>(headers);
    try {
        fields.emplace_back(name == nullptr ? "" : name, value == nullptr ? "" : value);
        return MHD_YES;
    } catch (const std::exception&) {
        fields.clear();
        return MHD_NO;
    }
}

Answer answer_of_exception(std::string_view what) {
    Answer answer;
    answer.status = 503;
    try {
        answer = come_back(std::chrono::seconds{5}, "This server cannot answer at the moment.");
        answer.trouble = what;
    } catch (const std::exception&) {
        // Memory is short; send the status only.
    }
    return answer;
}

// Calls `make`. Answers 503 if it throws, because an answer that fails, perhaps for lack of memory,
// must not stop the server.
template <class Make>
std::optional<Answer> made_or_503(const Make& make) {
    try {
        return make();
    } catch (const std::exception& error) {
        return answer_of_exception(error.what());
    } catch (...) {
        return answer_of_exception("an exception without a text");
    }
}

// A request, from its first line to the end of its answer.
struct Exchange {
    RawRequest raw;
    Request request;
    std::shared_ptr<Door> door;
    std::optional<Answer> answer;
    std::shared_ptr<StreamFeed> feed;
    std::string counts_as;      // name of the client for limits
    bool holds_budget = false;  // the answer budget counts the bytes
    SteadyClock::time_point began = SteadyClock::now();
    enum class Stage { first_line, headers, answer };  // how far it has been read
    Stage stage = Stage::first_line;
};

}  // namespace

struct Server::Impl {
    Impl(ServerOptions given, std::shared_ptr<const Doors> opened)
        : options(std::move(given)),
          doors(std::move(opened)),
          identity(identity_of(options)),
          watch(options.limits, identity.proxies),
          budget(options.limits.answer_bytes),
          queue(options.limits.workers, options.limits.most_waiting) {}

    struct Listener {
        MHD_Daemon* daemon = nullptr;
        std::string url;
        Descriptor silent;  // an eventfd to which nobody writes
    };

    Status listen(const ListenSocket& socket);
    static void stop_listening(const Listener& listener);
    MHD_Result handle(MHD_Connection* connection, const char* method, const char* version,
                      Exchange& exchange);
    bool is_refused(MHD_Connection* connection, const char* method, const char* version,
                    Exchange& exchange) const;
    // Returns false if a worker makes the answer. libmicrohttpd asks again when the answer is
    // there.
    bool begin(MHD_Connection* connection, Exchange& exchange);
    bool let_work(MHD_Connection* connection, Exchange& exchange);
    void hand_over(WorkQueue& workers, MHD_Connection* connection, Exchange& exchange,
                   bool may_take_long);
    void work(WorkQueue::Turn turn, MHD_Connection* connection, Exchange& exchange,
              bool may_take_long);
    void take_budget(Exchange& exchange);
    MHD_Result send(MHD_Connection* connection, Exchange& exchange);
    void stop();
    void wait_until_idle(std::chrono::milliseconds most) const;

    static void* first_line(void* self, const char* uri, MHD_Connection* connection);
    static MHD_Result request(void* self, MHD_Connection* connection, const char* url,
                              const char* method, const char* version, const char* data,
                              std::size_t* data_size, void** exchange);
    static void completed(void* self, MHD_Connection* connection, void** exchange,
                          MHD_RequestTerminationCode why);
    static MHD_Result accepts(void* self, const sockaddr* address, socklen_t size);
    static void connection(void* self, MHD_Connection* connection, void** of_connection,
                           MHD_ConnectionNotificationCode what);

    const ServerOptions options;
    const std::shared_ptr<const Doors> doors;
    const Identity identity;
    ConnectionWatch watch;
    AnswerBudget budget;
    Mutex feeds_mutex;
    std::set<std::shared_ptr<StreamFeed>> feeds STORMCELLAR_GUARDED_BY(feeds_mutex);
    std::atomic<bool> is_stopping = false;
    std::vector<Listener> listeners;
    WorkQueue queue;
};

// Begins a request. libmicrohttpd passes the returned pointer to the functions below, as the
// pointer of this request.
void* Server::Impl::first_line(void* /*self*/, const char* uri, MHD_Connection* /*connection*/) {
    try {
        auto exchange = std::make_unique<Exchange>();
        exchange->raw.target = uri;
        return exchange.release();
    } catch (const std::exception&) {
        return nullptr;  // request() will then close the connection
    }
}

MHD_Result Server::Impl::request(void* self, MHD_Connection* connection, const char* /*url*/,
                                 const char* method, const char* version, const char* /*data*/,
                                 std::size_t* data_size, void** exchange) {
    if (*exchange == nullptr) return MHD_NO;
    *data_size = 0;
    try {
        return static_cast<Impl*>(self)->handle(connection, method, version,
                                                *static_cast<Exchange*>(*exchange));
    } catch (const std::exception&) {
        return MHD_NO;
    }
}

void Server::Impl::completed(void* self, MHD_Connection* connection, void** exchange,
                             MHD_RequestTerminationCode /*why*/) {
    auto* impl = static_cast<Impl*>(self);
    const std::unique_ptr<Exchange> ended(static_cast<Exchange*>(*exchange));
    *exchange = nullptr;
    impl->watch.answered(connection);
    if (ended == nullptr) return;
    if (ended->holds_budget)
        impl->budget.give_back(ended->counts_as, std::get<Pieces>(ended->answer->body));
    if (ended->feed == nullptr) return;
    const MutexLock lock(impl->feeds_mutex);
    impl->feeds.erase(ended->feed);
}

MHD_Result Server::Impl::accepts(void* self, const sockaddr* address, socklen_t /*size*/) {
    try {
        const auto& watch = static_cast<Impl*>(self)->watch;
        return watch.may_open(end_point_of(address).address) ? MHD_YES : MHD_NO;
    } catch (const std::exception&) {
        return MHD_NO;
    }
}

void Server::Impl::connection(void* self, MHD_Connection* connection, void** /*of_connection*/,
                              MHD_ConnectionNotificationCode what) {
    auto* impl = static_cast<Impl*>(self);
    if (what == MHD_CONNECTION_NOTIFY_CLOSED) {
        impl->watch.closed(connection);
        return;
    }
    const auto* socket = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    const auto* client = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CLIENT_ADDRESS);
    if (socket == nullptr || client == nullptr) return;
    try {
        impl->watch.opened(connection, socket->connect_fd,
                           end_point_of(client->client_addr).address);
    } catch (const std::exception&) {
        ::shutdown(socket->connect_fd, SHUT_RDWR);
    }
}

// Handles a request. libmicrohttpd calls this when the headers have come, again at the end of the
// request, and again when a suspended connection is resumed. At the first call the client may still
// be sending a body, so that an answer would close the connection. So the first call only refuses.
MHD_Result Server::Impl::handle(MHD_Connection* connection, const char* method, const char* version,
                                Exchange& exchange) {
    switch (exchange.stage) {
        case Exchange::Stage::first_line:
            exchange.stage = Exchange::Stage::headers;
            watch.request_arrived(connection);
            return is_refused(connection, method, version, exchange) ? send(connection, exchange)
                                                                     : MHD_YES;
        case Exchange::Stage::headers:
            exchange.stage = Exchange::Stage::answer;
            return begin(connection, exchange) ? send(connection, exchange) : MHD_YES;
        case Exchange::Stage::answer:
            return send(connection, exchange);
    }
    return MHD_NO;
}

bool Server::Impl::is_refused(MHD_Connection* connection, const char* method, const char* version,
                              Exchange& exchange) const {
    RawRequest& raw = exchange.raw;
    raw.method = method;
    raw.is_http_1_0 = std::string_view{version} == "HTTP/1.0";
    MHD_get_connection_values(connection, MHD_HEADER_KIND, &take_header, &raw.headers);
    const auto* client = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CLIENT_ADDRESS);
    if (client != nullptr) raw.client = end_point_of(client->client_addr).address;
    Reading reading = read_request(raw, identity);
    exchange.request = std::move(reading.request);
    exchange.counts_as = client_network(exchange.request.client);
    if (!reading.refusal) return false;
    exchange.answer = sentence(reading.refusal->status, reading.refusal->reason);
    if (reading.refusal->status == 405) exchange.answer->with("Allow", "GET, HEAD, OPTIONS");
    exchange.answer->closes = true;
    return true;
}

bool Server::Impl::begin(MHD_Connection* connection, Exchange& exchange) {
    if (exchange.request.verb == Verb::options) {
        exchange.answer.emplace();
        exchange.answer->status = 204;
        exchange.answer->with("Allow", "GET, HEAD, OPTIONS");
        return true;
    }
    exchange.door = doors->find(exchange.request.path);
    exchange.answer =
        exchange.door == nullptr
            ? sentence(404, "There is nothing at this address.")
            : made_or_503([&] { return exchange.door->answer_at_once(exchange.request); });
    return exchange.answer || let_work(connection, exchange);
}

// Suspends the connection until a worker has made the answer.
bool Server::Impl::let_work(MHD_Connection* connection, Exchange& exchange) {
    MHD_suspend_connection(connection);
    hand_over(exchange.door->workers() ? *exchange.door->workers() : queue, connection, exchange,
              exchange.door->long_workers() == nullptr);
    return false;
}

// Hands the exchange to a worker. The worker owns it from the moment when the work is added until
// it resumes the connection.
void Server::Impl::hand_over(WorkQueue& workers, MHD_Connection* connection, Exchange& exchange,
                             bool may_take_long) {
    const auto added = made_or_503([&]() -> std::optional<Answer> {
        const bool is_added = workers.add(
            exchange.counts_as, [this, connection, &exchange, may_take_long](WorkQueue::Turn turn) {
                work(turn, connection, exchange, may_take_long);
            });
        if (is_added) return std::nullopt;
        return come_back(std::chrono::seconds{2},
                         "This server has too many requests at the moment; try again.");
    });
    if (!added) return;
    exchange.answer = added;
    MHD_resume_connection(connection);
}

void Server::Impl::work(WorkQueue::Turn turn, MHD_Connection* connection, Exchange& exchange,
                        bool may_take_long) {
    Door& door = *exchange.door;
    exchange.answer = made_or_503([&]() -> std::optional<Answer> {
        switch (turn) {
            case WorkQueue::Turn::came:
                return may_take_long ? door.answer(exchange.request)
                                     : door.answer_soon(exchange.request);
            case WorkQueue::Turn::stopping:
                return come_back(std::chrono::seconds{5}, "The server is stopping.");
            case WorkQueue::Turn::lost:
                return come_back(std::chrono::seconds{2},
                                 "Clients with fewer requests go first; try again.");
        }
        return std::nullopt;
    });
    if (exchange.answer) {
        MHD_resume_connection(connection);
    } else {
        hand_over(*door.long_workers(), connection, exchange, true);
    }
}

// Takes room for the answer's bytes from the budget, also for HEAD: a client may send many such
// requests and read nothing, and the server holds all of their answers.
void Server::Impl::take_budget(Exchange& exchange) {
    const auto* pieces = std::get_if<Pieces>(&exchange.answer->body);
    if (pieces == nullptr) return;
    exchange.holds_budget = budget.take(exchange.counts_as, *pieces);
    if (exchange.holds_budget) return;
    watch.memory_is_short();
    exchange.answer =
        come_back(std::chrono::seconds{10},
                  "Too many bytes are on their way, to all clients or to this one; try again.");
}

MHD_Result Server::Impl::send(MHD_Connection* connection, Exchange& exchange) {
    if (!exchange.answer) return MHD_NO;
    take_budget(exchange);
    Answer& answer = *exchange.answer;
    add_common_headers(answer, exchange.request, options.origins);
    if (is_stopping) answer.closes = true;
    const bool is_stream = !std::holds_alternative<Pieces>(answer.body);
    const HttpResponse response =
        make_response(answer, exchange.request.verb, connection, &exchange.feed);
    if (response == nullptr) return MHD_NO;
    if (exchange.feed != nullptr) {
        const MutexLock lock(feeds_mutex);
        feeds.insert(exchange.feed);
        if (is_stopping) exchange.feed->end();
    }
    const std::uint64_t bytes = is_stream ? 0 : size_of(std::get<Pieces>(answer.body));
    const bool holds_memory =
        exchange.holds_budget && AnswerBudget::is_counted(std::get<Pieces>(answer.body));
    if (options.on_answer) {
        options.on_answer({&exchange.request, answer.status, bytes,
                           SteadyClock::now() - exchange.began, answer.trouble});
    }
    if (exchange.feed != nullptr) {
        watch.sending_stream(connection, exchange.feed);
    } else {
        watch.sending_body(connection, exchange.request.verb == Verb::head ? 0 : bytes,
                           holds_memory);
    }
    return MHD_queue_response(connection, answer.status, response.get());
}

Status Server::Impl::listen(const ListenSocket& socket) {
    Descriptor silent{::eventfd(0, EFD_CLOEXEC)};
    if (!silent.is_open()) return system_failure("cannot listen on " + socket.url, errno);
    // Leave paths and queries encoded. read_request() decodes them, and refuses some that
    // libmicrohttpd would accept.
    const auto undecoded =
        +[](void*, MHD_Connection*, char* text) { return std::char_traits<char>::length(text); };
    const auto option = [&](MHD_OPTION which, auto callback) {
        return MHD_OptionItem{which, reinterpret_cast<std::intptr_t>(callback), this};
    };
    const Result<MHD_Daemon*> daemon = start_http_daemon(
        socket.socket->number(),
        {.flags = MHD_USE_EPOLL_INTERNAL_THREAD | MHD_ALLOW_SUSPEND_RESUME,
         .most_connections = options.limits.most_connections + options.limits.most_streams + 1,
         .header_bytes = options.limits.header_bytes,
         .self = this,
         .accepts = &Impl::accepts,
         .answer = &Impl::request,
         .connection = &Impl::connection,
         .others = {option(MHD_OPTION_URI_LOG_CALLBACK, &Impl::first_line),
                    option(MHD_OPTION_UNESCAPE_CALLBACK, undecoded),
                    option(MHD_OPTION_NOTIFY_COMPLETED, &Impl::completed)}});
    if (!daemon) return pass_on(daemon);
    listeners.push_back({*daemon, socket.url, std::move(silent)});
    return {};
}

// Stops listening, but not with MHD_quiesce_daemon(). That function and the daemon's thread may
// both remove the socket from the epoll set, and the second removal ends the program (libmicrohttpd
// 0.9.75). Instead, replaces the daemon's descriptor by one at which nothing ever happens.
void Server::Impl::stop_listening(const Listener& listener) {
    const auto info = [&](MHD_DaemonInfoType type) {
        return MHD_get_daemon_info(listener.daemon, type);
    };
    const int epoll = info(MHD_DAEMON_INFO_EPOLL_FD)->epoll_fd;
    const int listening = info(MHD_DAEMON_INFO_LISTEN_FD)->listen_fd;
    // If the daemon is at its limit of connections, it has removed the socket itself and will add
    // it again later.
    const bool was_in = ::epoll_ctl(epoll, EPOLL_CTL_DEL, listening, nullptr) == 0;
    ::dup3(listener.silent.number(), listening, O_CLOEXEC);
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.ptr = listener.daemon;
    if (was_in) ::epoll_ctl(epoll, EPOLL_CTL_ADD, listening, &event);
}

void Server::Impl::wait_until_idle(std::chrono::milliseconds most) const {
    const auto until = SteadyClock::now() + most;
    while (SteadyClock::now() < until && !watch.is_idle())
        std::this_thread::sleep_for(std::chrono::milliseconds{10});
}

// Stops the server. No connection may be suspended when libmicrohttpd is stopped.
void Server::Impl::stop() {
    is_stopping = true;
    for (const Listener& listener : listeners)
        stop_listening(listener);
    {
        const MutexLock lock(feeds_mutex);
        for (const auto& feed : feeds)
            feed->end();
    }
    // Wait until requests that have come, or are about to come, are answered and the answers are
    // sent.
    wait_until_idle(std::chrono::seconds{2});
    // Tell the clients of requests that still wait to come back.
    queue.stop();
    for (const auto& workers : doors->workers())
        workers->stop();
    wait_until_idle(std::chrono::milliseconds{200});
    for (const Listener& listener : listeners)
        MHD_stop_daemon(listener.daemon);
    listeners.clear();
}

Server::Server(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Server::~Server() {
    impl_->stop();
}

Result<std::unique_ptr<Server>> Server::open(ServerOptions options,
                                             std::shared_ptr<const Doors> doors,
                                             ListenSockets sockets) {
    if (sockets.empty()) {
        auto opened = open_listen_sockets(options.listen);
        if (!opened) return pass_on(opened);
        sockets = std::move(*opened);
    }
    auto impl = std::make_unique<Impl>(std::move(options), std::move(doors));
    std::unique_ptr<Server> server(new Server(std::move(impl)));
    for (const ListenSocket& socket : sockets) {
        if (const Status listening = server->impl_->listen(socket); !listening)
            return tl::unexpected(listening.error());
    }
    return server;
}

std::vector<std::string> Server::addresses() const {
    std::vector<std::string> urls;
    for (const Impl::Listener& listener : impl_->listeners)
        urls.push_back(listener.url);
    return urls;
}

ServerFacts Server::facts() const {
    ServerFacts facts{.connections = impl_->watch.count(),
                      .waiting = impl_->queue.waiting(),
                      .working = impl_->queue.working(),
                      .answer_bytes = impl_->budget.bytes()};
    for (const auto& workers : impl_->doors->workers()) {
        facts.waiting += workers->waiting();
        facts.working += workers->working();
    }
    const MutexLock lock(impl_->feeds_mutex);
    facts.streams = impl_->feeds.size();
    return facts;
}

}  // namespace stormcellar::web
