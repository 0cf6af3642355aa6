#include "web/service/measures.h"

#include <algorithm>
#include <fstream>

#include <sys/resource.h>
#include <unistd.h>

#include "stormcellar/base/utc_time.h"
#include "stormcellar/base/version.h"

namespace stormcellar::web {
namespace {

double resident_bytes() {
    std::ifstream statm("/proc/self/statm");
    double all = 0, resident = 0;
    statm >> all >> resident;
    return resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

double cpu_seconds() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace

Measures::Measures() {
    Counters& add = *counters_;
    add.add_gauge("stormcellar_web_build_info", "Always 1.", [] { return 1.0; },
                  {{"version", std::string(software_version)}});
    const double start = static_cast<double>(now_utc().time_since_epoch().count()) / 1000;
    add.add_gauge("stormcellar_web_start_time_seconds",
                  "When the server began, or last took over a configuration, since 1970.",
                  [start] { return start; });
    add.add_gauge("stormcellar_web_resident_bytes", "Memory of the process.", resident_bytes);
    add.add_counter("stormcellar_web_cpu_seconds_total", "Time of processors that it used.",
                    cpu_seconds);
    struct Gauge {
        const char *name, *help;
        std::size_t ServerFacts::*value;
    };
    for (const Gauge& gauge :
         {Gauge{"stormcellar_web_connections", "Open connections, with those of event streams.",
                &ServerFacts::connections},
          Gauge{"stormcellar_web_streams", "Open event streams.", &ServerFacts::streams},
          Gauge{"stormcellar_web_waiting_requests", "Requests that wait for a worker.",
                &ServerFacts::waiting},
          Gauge{"stormcellar_web_working_requests", "Requests that workers answer now.",
                &ServerFacts::working},
          Gauge{"stormcellar_web_answer_memory_bytes",
                "Memory of answers that are on their way to clients.",
                &ServerFacts::answer_bytes}}) {
        add.add_gauge(gauge.name, gauge.help, [server = server_, value = gauge.value] {
            const Server* running = *server;
            return running == nullptr ? 0.0 : static_cast<double>(running->facts().*value);
        });
    }
}

void Measures::count_doors(const Doors& doors) {
    for (const std::string& prefix : doors.prefixes())
        counters_->add_door(prefix);
}

void Measures::watch_grids(const std::shared_ptr<Grids>& grids) {
    counters_->add_counter("stormcellar_web_cache_changes_total",
                           "Grids that came, changed or went, those at the start included.",
                           [grids] { return static_cast<double>(grids->changes()); });
    counters_->add_gauge("stormcellar_web_cache_watched",
                         "1 if changes of the cache are noticed at once, 0 if it is read again and "
                         "again or is not there.",
                         [grids] { return grids->problem() ? 0.0 : 1.0; });
}

void Measures::watch_events(const std::shared_ptr<EventHub>& hub,
                            const std::shared_ptr<const EventFeed>& feed) {
    Counters& add = *counters_;
    add.add_counter("stormcellar_web_events_total", "Events that were published.",
                    [hub] { return static_cast<double>(hub->published()); });
    add.add_counter("stormcellar_web_event_resets_total",
                    "How often a client of events was told that it lost some.",
                    [hub] { return static_cast<double>(hub->resets()); });
    add.add_counter("stormcellar_web_unreadable_grids_total",
                    "Grids of which no event could be made since they could not be read.",
                    [feed] { return static_cast<double>(feed->unreadable()); });
    add.add_gauge("stormcellar_web_stations", "Stations of which something is known.",
                  [feed] { return static_cast<double>(feed->stations().size()); });
    add.add_gauge(
        "stormcellar_web_silent_stations",
        "Stations from which nothing came for [web] silent_seconds.", [feed] {
            const auto pages = feed->stations();
            return static_cast<double>(std::count_if(
                pages.begin(), pages.end(), [](const auto& page) { return page.is_silent; }));
        });
}

}  // namespace stormcellar::web
