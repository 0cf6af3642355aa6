#include "web/doors/index/page.h"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "stormcellar/base/version.h"
#include "stormcellar/level2/moment.h"
#include "web/doors/index/clients.h"
#include "web/http/answer.h"
#include "web/http/request.h"

namespace stormcellar::web {
namespace {

using std::chrono::days;
using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;
using std::chrono::years;

std::string whole_seconds(UtcTime time) {
    return format_utc(std::chrono::time_point_cast<seconds>(time));
}

// Returns "2026-05-01 12:00:31", for people.
std::string readable(UtcTime time) {
    std::string text = whole_seconds(time);
    std::replace(text.begin(), text.end(), 'T', ' ');
    text.pop_back();
    return text;
}

// Returns "2026, 5, 1, 12, 0", for Python.
std::string arguments_of_datetime(UtcTime time) {
    const auto day = std::chrono::floor<days>(time);
    const std::chrono::year_month_day date{day};
    const std::chrono::hh_mm_ss clock{std::chrono::floor<minutes>(time - day)};
    return fmt::format("{}, {}, {}, {}, {}", static_cast<int>(date.year()),
                       static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                       clock.hours().count(), clock.minutes().count());
}

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words)
        text += (text.empty() ? "" : " ") + word;
    return text;
}

// Returns the state. Data that come late, as in a replay of an archive, do not make a station live.
std::string_view state_of(const IndexStation& station, UtcTime now) {
    if (station.is_silent) return "silent";
    const auto is_live = [&](std::optional<UtcTime> newest) {
        return newest && is_believed(*newest, now) && now - *newest < hours{1};
    };
    return is_live(station.newest_volume) || is_live(station.newest_grid) ? "live" : "archive";
}

class IndexPage {
  public:
    explicit IndexPage(const IndexFacts& facts) : facts_(facts), path_(path_of_base(facts.base)) {}
    std::string written() {
        head();
        text_ += "<main>\n<div class=\"data\">\n";
        stations();
        domains();
        text_ += "</div>\n";
        clients();
        text_ += "</main>\n";
        footer();
        return std::move(text_);
    }

  private:
    template <class... Values>
    void add(fmt::format_string<Values...> format, Values&&... values) {
        fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
    }
    [[nodiscard]] bool has(std::string_view door) const {
        return std::find(facts_.doors.begin(), facts_.doors.end(), door) != facts_.doors.end();
    }
    // Writes a link to a path of this server, if the door exists.
    void link(std::string_view door, std::string_view path, std::string_view words,
              std::string_view kind = "") {
        if (!has(door)) return;
        add("<a{} href=\"{}\">{}</a>\n", kind.empty() ? "" : fmt::format(" class=\"{}\"", kind),
            xml_escaped(std::string(path_) + std::string(path)), words);
    }
    // Writes an age, and below it the time.
    void age(std::string_view label, std::optional<UtcTime> time, std::string_view none = "none") {
        if (!time) {
            add("<td class=\"age\" data-label=\"{}\"><span class=\"none\">{}</span></td>\n", label,
                none);
            return;
        }
        add("<td class=\"age\" data-label=\"{}\"><b>{}</b> <time datetime=\"{}\">{}</time></td>\n",
            label, age_text(*time, facts_.now), whole_seconds(*time), readable(*time));
    }
    void head();
    void stations();
    void station(const IndexStation& station);
    void domains();
    void clients();
    void footer();
    [[nodiscard]] std::string summary() const;
    [[nodiscard]] ClientPlaces places() const;

    const IndexFacts& facts_;
    const std::string_view path_;
    std::string text_;
};

std::string IndexPage::summary() const {
    if (facts_.stations.empty()) return "Nothing has come yet.";
    std::optional<UtcTime> newest;
    std::size_t silent = 0;
    for (const IndexStation& station : facts_.stations) {
        if (station.is_silent) ++silent;
        for (const auto& time : {station.newest_volume, station.newest_grid})
            if (time) newest = newest ? std::max(*newest, *time) : *time;
    }
    std::string text =
        fmt::format("{} station{}", facts_.stations.size(), facts_.stations.size() == 1 ? "" : "s");
    if (silent > 0) text += fmt::format(", {} of them silent", silent);
    if (newest && *newest > facts_.now + minutes{1}) {
        text += "; the newest volume has a time in the future";
    } else if (newest) {
        text += fmt::format("; the newest volume began {} ago", age_text(*newest, facts_.now));
    }
    return text + ".";
}

void IndexPage::head() {
    const std::size_t scheme = facts_.base.find("://");
    const std::string host = facts_.base.substr(scheme == std::string::npos ? 0 : scheme + 3);
    add("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<title>Weather radar: {0}</title>\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta name=\"color-scheme\" content=\"light dark\">\n"
        "<link rel=\"icon\" href=\"data:,\">\n"
        "<link rel=\"stylesheet\" href=\"{1}/index.css\">\n"
        "</head>\n<body>\n<header>\n<p class=\"brand\">stormcellar</p>\n"
        "<h1>Weather radar <span>{0}</span></h1>\n"
        "<p class=\"lead\">{2}</p>\n"
        "<p class=\"asof\">As of {3} UTC. <a href=\"{1}/\">Reload</a></p>\n<nav>\n",
        xml_escaped(host), xml_escaped(path_), summary(), readable(facts_.now));
    link("/view", "/view/", "Open the viewer", "button");
    text_ += "<a href=\"#connect\">Connect a program</a>\n";
    link("/api/v1", "/api/v1", "API");
    link("/api/v1", "/api/v1/openapi.json", "OpenAPI");
    link("/volumes", "/volumes/", "Volumes");
    link("/thredds", "/thredds/radarServer/catalog.xml", "THREDDS");
    link("/zarr", "/zarr", "Zarr");
    link("/tiles", "/tiles", "Tiles");
    link("/metrics", "/metrics", "Metrics");
    text_ += "</nav>\n</header>\n";
}

void IndexPage::station(const IndexStation& station) {
    const std::string icao = encoded(station.icao);
    const std::string_view state = state_of(station, facts_.now);
    add("<tr class=\"{}\">\n<th scope=\"row\"><b>{}</b> <span>{}</span></th>\n"
        "<td class=\"state\" data-label=\"State\"><i>{}</i>{}</td>\n",
        state, xml_escaped(station.icao), xml_escaped(station.place), state,
        station.is_silent && station.heard
            ? fmt::format(" for {}", age_text(*station.heard, facts_.now))
            : "");
    // Volumes from the future do not count.
    const bool is_ahead = station.newest_grid && !is_believed(*station.newest_grid, facts_.now);
    age("Newest volume", station.newest_volume, is_ahead ? "not known" : "none");
    age("Newest grid", station.newest_grid);
    add("<td class=\"moments\" data-label=\"Moments\">{}</td>\n",
        xml_escaped(joined(station.moments)));
    text_ += "<td class=\"links\">";
    link("/volumes", "/volumes/" + icao + "/", "volumes");
    if (!station.moments.empty()) link("/api/v1", "/api/v1/grids?domain=" + icao, "grids");
    link("/api/v1", "/api/v1/stations?station=" + icao, "about");
    text_ += "</td>\n</tr>\n";
}

void IndexPage::stations() {
    text_ += "<section>\n<h2>Stations</h2>\n";
    if (facts_.stations.empty()) {
        text_ +=
            "<p>There are none yet: neither the catalog nor the cache has any.</p>\n</section>\n";
        return;
    }
    text_ +=
        "<table>\n<thead><tr><th scope=\"col\">Station</th><th scope=\"col\">State</th>"
        "<th scope=\"col\">Newest volume</th><th scope=\"col\">Newest grid</th>"
        "<th scope=\"col\">Moments</th><th scope=\"col\">Links</th></tr></thead>\n<tbody>\n";
    for (const IndexStation& one : facts_.stations)
        station(one);
    text_ += "</tbody>\n</table>\n";
    if (facts_.is_cut) text_ += "<p>There are more: the API lists all of them.</p>\n";
    text_ += "</section>\n";
}

void IndexPage::domains() {
    if (facts_.domains.empty()) return;
    text_ +=
        "<section>\n<h2>Mosaics</h2>\n<table>\n<thead><tr><th scope=\"col\">Domain</th>"
        "<th scope=\"col\">Newest grid</th><th scope=\"col\">Moments</th>"
        "<th scope=\"col\">Links</th></tr></thead>\n<tbody>\n";
    for (const IndexDomain& domain : facts_.domains) {
        add("<tr>\n<th scope=\"row\"><b>{}</b></th>\n", xml_escaped(domain.name));
        age("Newest grid", domain.newest);
        add("<td class=\"moments\" data-label=\"Moments\">{}</td>\n<td class=\"links\">",
            xml_escaped(joined(domain.moments)));
        link("/api/v1", "/api/v1/grids?domain=" + encoded(domain.name), "grids");
        text_ += "</td>\n</tr>\n";
    }
    text_ += "</tbody>\n</table>\n</section>\n";
}

// Chooses the places for the examples, preferably a live station, which has more to show.
ClientPlaces IndexPage::places() const {
    ClientPlaces places{facts_.base,
                        facts_.bucket,
                        "KTLX",
                        "KTLX",
                        std::string(level2::moment_name(level2::Moment::ref)),
                        "2026/05/01",
                        "2026, 5, 1, 12, 0"};
    const IndexStation* best = nullptr;
    for (const IndexStation& station : facts_.stations) {
        const auto worth = [](const IndexStation& one) {
            return (one.newest_volume ? 2 : 0) + (one.is_silent ? 0 : 1);
        };
        if (best == nullptr || worth(station) > worth(*best)) best = &station;
    }
    if (best != nullptr) {
        places.station = places.domain = best->icao;
        if (best->newest_volume) {
            const std::string day = whole_seconds(*best->newest_volume);
            places.day = day.substr(0, 4) + "/" + day.substr(5, 2) + "/" + day.substr(8, 2);
            places.when = arguments_of_datetime(*best->newest_volume);
        }
        if (!best->moments.empty()) places.moment = best->moments.front();
        if (best->moments.empty() && !facts_.domains.empty()) {
            places.domain = facts_.domains.front().name;
            places.moment = facts_.domains.front().moments.front();
        }
    }
    return places;
}

void IndexPage::clients() {
    const auto help = client_help(places(), facts_.doors);
    if (help.empty()) return;
    text_ += "<section id=\"connect\">\n<h2>Connect a program</h2>\n";
    for (std::size_t i = 0; i < help.size(); ++i) {
        add("<details{}>\n<summary>{}</summary>\n<p>{}</p>\n<pre><code>{}</code></pre>\n"
            "</details>\n",
            i == 0 ? " open" : "", xml_escaped(help[i].program), xml_escaped(help[i].text),
            xml_escaped(help[i].code));
    }
    text_ += "</section>\n";
}

void IndexPage::footer() {
    add("<footer>\n<p>stormcellar {}. Times are UTC. Ages are those of the radar's clock.</p>\n"
        "</footer>\n</body>\n</html>\n",
        software_version);
}

}  // namespace

std::string age_text(UtcTime from, UtcTime to) {
    const auto age = to - from;
    if (age < -minutes{1}) return "in the future";
    const auto whole = std::max(std::chrono::floor<seconds>(age), seconds{0});
    if (whole < seconds{90}) return fmt::format("{} s", whole.count());
    if (whole < minutes{90}) return fmt::format("{} min", whole / minutes{1});
    if (whole < days{2})
        return fmt::format("{} h {} min", whole / hours{1}, whole % hours{1} / minutes{1});
    if (whole < days{2 * 365}) return fmt::format("{} days", whole / days{1});
    return fmt::format("{} years", whole / years{1});
}

std::string_view path_of_base(std::string_view base) {
    const std::size_t scheme = base.find("://");
    if (scheme == std::string_view::npos) return {};
    const std::size_t slash = base.find('/', scheme + 3);
    return slash == std::string_view::npos ? std::string_view{} : base.substr(slash);
}

std::string index_html(const IndexFacts& facts) {
    return IndexPage(facts).written();
}

}  // namespace stormcellar::web
