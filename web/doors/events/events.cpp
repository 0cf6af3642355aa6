#include "web/doors/events/events.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "stormcellar/base/mutex.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/cache/grid_name.h"
#include "web/http/client_address.h"

namespace stormcellar::web {
namespace {

constexpr std::size_t most_filter_values = 64;  // of each list

// Adds the values of a parameter. The parameter may be repeated, and each may be a list with
// commas. `parse` returns none for a value that makes no sense.
template <class Values, class Parse>
Status add_values(const Request& request, std::string_view name, std::string_view what, Parse parse,
                  Values& values) {
    for (std::string_view text : request.parameters(name)) {
        while (true) {
            const std::size_t comma = text.find(',');
            const std::string_view word = text.substr(0, comma);
            auto value = parse(word);
            if (!value)
                return fail(ErrorCode::bad_argument, "{}: {}, not '{}'", name, what,
                            word.substr(0, 40));
            if (std::find(values.begin(), values.end(), *value) == values.end())
                values.push_back(std::move(*value));
            if (values.size() > most_filter_values)
                return fail(ErrorCode::bad_argument, "{}: at most {} of them", name,
                            most_filter_values);
            if (comma == std::string_view::npos) break;
            text.remove_prefix(comma + 1);
        }
    }
    return {};
}

std::optional<std::string> domain_of(std::string_view text) {
    if (!cache::is_domain_name(text) || cache::is_part(text)) return std::nullopt;
    return std::string(text);
}

std::optional<EventType> kind_of_event(std::string_view text) {
    const auto type = event_type_from_name(text);
    return type == EventType::reset ? std::nullopt : type;
}

std::string names_of_kinds() {
    std::string names;
    for (const EventTypeFacts& facts : event_types) {
        if (facts.type == EventType::reset) continue;
        names += names.empty() ? "" : ", ";
        names += facts.name;
    }
    return names;
}

Result<EventFilter> filter_of(const Request& request) {
    constexpr std::array known{"station", "domain", "moment", "kind", "last_event_id"};
    for (const auto& [name, value] : request.query) {
        if (std::find(known.begin(), known.end(), name) == known.end())
            return fail(ErrorCode::bad_argument, "there is no parameter '{}' of /api/v1/events",
                        name.substr(0, 40));
    }
    EventFilter filter;
    Status good = add_values(request, "station", "four letters or digits, like KTLX", icao_of,
                             filter.stations);
    if (good)
        good = add_values(request, "domain", "the name of a domain", domain_of, filter.domains);
    if (good)
        good = add_values(request, "moment", level2::moment_names(", ", " or "),
                          level2::moment_from_name, filter.moments);
    if (good) good = add_values(request, "kind", names_of_kinds(), kind_of_event, filter.types);
    if (!good) return pass_on(good);
    return filter;
}

// The body for a HEAD request. The server reads nothing from it.
class NoEvents final : public Stream {
  public:
    std::optional<std::string> read(std::size_t /*most*/) override { return std::nullopt; }
    void on_more(std::function<void()> /*more*/) override {}
};

}  // namespace

// Counts the open streams of each client.
class EventsDoor::Places {
  public:
    // Takes a place for the client. Returns false if the limit of streams is reached.
    bool take(const std::string& client, const EventsOptions& options) {
        const MutexLock lock(mutex_);
        if (all_ >= options.most_streams) return false;
        std::size_t& theirs = by_client_[client];
        if (theirs >= options.most_of_client) return false;
        ++theirs;
        ++all_;
        return true;
    }
    void leave(const std::string& client) {
        const MutexLock lock(mutex_);
        const auto theirs = by_client_.find(client);
        if (--theirs->second == 0) by_client_.erase(theirs);
        --all_;
    }
    // A listener that holds a place. Its destructor gives the client's place back.
    class Taken;

  private:
    Mutex mutex_;
    std::size_t all_ STORMCELLAR_GUARDED_BY(mutex_) = 0;
    std::map<std::string, std::size_t> by_client_ STORMCELLAR_GUARDED_BY(mutex_);
};

class EventsDoor::Places::Taken final : public Stream {
  public:
    Taken(std::shared_ptr<Places> places, std::string client,
          std::shared_ptr<EventHub::Listener> listener)
        : places_(std::move(places)), client_(std::move(client)), listener_(std::move(listener)) {}
    Taken(const Taken&) = delete;
    Taken& operator=(const Taken&) = delete;
    ~Taken() override { places_->leave(client_); }

    std::optional<std::string> read(std::size_t most) override { return listener_->read(most); }
    void on_more(std::function<void()> more) override { listener_->on_more(std::move(more)); }

  private:
    const std::shared_ptr<Places> places_;
    const std::string client_;
    const std::shared_ptr<EventHub::Listener> listener_;
};

EventsDoor::EventsDoor(EventsOptions options)
    : options_(std::move(options)), places_(std::make_shared<Places>()) {}
EventsDoor::~EventsDoor() = default;

std::optional<Answer> EventsDoor::answer_at_once(const Request& request) {
    return answer(request);
}

Answer EventsDoor::answer(const Request& request) {
    if (segments_of(request.path).size() != 3)
        return json_error(404, "the API has no such path: /api/v1 lists those that there are");
    auto filter = filter_of(request);
    if (!filter) return json_error(filter.error());
    Answer answer;
    answer.with("Content-Type", "text/event-stream")
        .with("Cache-Control", "no-store")
        .with("X-Accel-Buffering", "no");
    if (request.verb == Verb::head) {
        answer.body = std::make_shared<NoEvents>();
        return answer;
    }
    const std::string client = client_network(request.client);
    if (!places_->take(client, options_)) {
        ++refused_;
        return come_back(std::chrono::seconds{10},
                         "There are as many streams of events as this server has; ask again.");
    }
    // A program that cannot set headers gives the id as a parameter. A browser that reconnects
    // repeats the parameter and adds a header. The header is newer, so it counts.
    std::optional<std::string> id = request.header("Last-Event-ID");
    if (!id) {
        if (const auto given = request.parameter("last_event_id")) id = std::string(*given);
    }
    answer.body = std::make_shared<Places::Taken>(
        places_, client, options_.hub->listen(std::move(*filter), std::move(id)));
    return answer;
}

}  // namespace stormcellar::web
