#include "web/doors/thredds/thredds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "web/data/grids/text_answer.h"

namespace stormcellar::web {
namespace {

constexpr std::chrono::hours nearest_within{1};

Answer xml_answer(const Request& request, std::string text) {
    return text_answer_to(request, "application/xml", std::move(text));
}

// Answers a query that failed. If the catalog cannot be read, the client made no mistake, so the
// answer has the status of an error.
Answer query_error(const Error& error) {
    if (error.code == ErrorCode::bad_argument)
        return sentence(200, error.message).with("Cache-Control", "no-cache");
    return sentence(status_of(error), "The catalog cannot be read now.");
}

// Returns the cosine of the angle between two places. It is smaller for places that are farther
// apart.
double closeness(const ThreddsQuery::Point& point, const ThreddsStation& station) {
    constexpr double radians = std::numbers::pi / 180;
    const double a = point.latitude_deg * radians, b = station.latitude_deg * radians;
    const double apart = (point.longitude_deg - station.longitude_deg) * radians;
    return std::sin(a) * std::sin(b) + std::cos(a) * std::cos(b) * std::cos(apart);
}

// Returns the identifiers of the stations that a query selects. They may be unknown stations if the
// query names them.
Result<std::vector<std::string>> stations_meant(ThreddsCollection& collection,
                                                const ThreddsQuery& query) {
    if (!query.stations.empty()) return query.stations;
    const auto all = collection.stations();
    if (!all) return pass_on(all);
    std::vector<std::string> meant;
    double closest = -std::numeric_limits<double>::infinity();
    for (const ThreddsStation& station : *all) {
        if (query.all_stations) {
            meant.push_back(station.id);
        } else if (!station.has_place) {
            continue;
        } else if (query.box) {
            if (is_inside(*query.box, station.latitude_deg, station.longitude_deg))
                meant.push_back(station.id);
        } else if (const double close = closeness(*query.near, station); close > closest) {
            closest = close;
            meant = {station.id};
        }
    }
    return meant;
}

// Returns the query as the client sent it, decoded.
std::string text_of_query(const Request& request) {
    std::string text;
    for (const auto& [name, value] : request.query)
        text += fmt::format("{}{}={}", text.empty() ? "" : "&", name, value);
    return text;
}

}  // namespace

ThreddsDoor::ThreddsDoor(const std::shared_ptr<RawFiles>& files, ThreddsOptions options)
    : options_(std::move(options)) {
    for (const ConfiguredCollection& configured : options_.config.collections)
        collections_.push_back(make_collection(configured, options_.config.places, files));
}

// Finds the data set with the longest matching path, because the path of one data set may begin
// with the path of another.
ThreddsDoor::Found ThreddsDoor::find(std::vector<std::string_view> segments) const {
    Found found;
    std::size_t longest = 0;
    for (const auto& collection : collections_) {
        const auto path = segments_of(collection->path());
        const bool fits = path.size() <= segments.size() && path.size() > longest &&
                          std::equal(path.begin(), path.end(), segments.begin());
        if (!fits) continue;
        longest = path.size();
        found.collection = collection;
    }
    segments.erase(segments.begin(), segments.begin() + static_cast<std::ptrdiff_t>(longest));
    found.rest = std::move(segments);
    return found;
}

bool ThreddsDoor::is_denied(std::string_view path) const {
    const std::vector<std::string_view> segments = segments_of(path);
    return std::ranges::any_of(options_.config.denied, [&](const std::string& denied) {
        const auto beginning = segments_of(denied);
        return beginning.size() < segments.size() &&
               std::equal(beginning.begin(), beginning.end(), segments.begin() + 1);
    });
}

std::optional<Answer> ThreddsDoor::answer_at_once(const Request& request) {
    const auto segments = segments_of(request.path);
    const bool is_file = segments.size() > 2 && segments[1] == "fileServer";
    if (!is_file || request.path.ends_with('/') || is_denied(request.path)) return std::nullopt;
    const Found found = find({segments.begin() + 2, segments.end()});
    return found.collection ? found.collection->file_at_once(request, found.rest) : std::nullopt;
}

Answer ThreddsDoor::answer(const Request& request) {
    if (is_denied(request.path)) return sentence(403, "This part is not for everybody.");
    const auto segments = segments_of(request.path);
    if (segments.size() == 2 && segments[1] == "catalog.xml")
        return xml_answer(request, thredds_top_xml(request));
    if (segments.size() > 1) {
        const std::vector<std::string_view> rest(segments.begin() + 2, segments.end());
        if (segments[1] == "radarServer") {
            Answer answer = radar_answer(request, rest);
            answer.closes = true;
            return answer;
        }
        if (segments[1] == "fileServer") return file_answer(request, rest);
    }
    return sentence(404, "There are radarServer/catalog.xml and fileServer/ here.");
}

Answer ThreddsDoor::radar_answer(const Request& request,
                                 const std::vector<std::string_view>& segments) const {
    if (segments.empty() && !request.path.ends_with('/'))
        return moved_to(request, request.path + "/");
    const bool is_top = segments.empty() || (segments.size() == 1 && segments[0] == "catalog.xml");
    if (is_top) return xml_answer(request, thredds_catalog_xml(request, collections_));
    const Found found = find(segments);
    if (!found.collection) return sentence(404, "There is no such data set.");
    if (found.rest.empty()) return query_answer(request, *found.collection);
    if (found.rest.size() != 1) return sentence(404, "There is nothing at this address.");
    const auto stations = found.collection->stations();
    if (!stations) return query_error(stations.error());
    if (found.rest[0] == "stations.xml")
        return xml_answer(request, thredds_stations_xml(*stations));
    if (found.rest[0] != "dataset.xml" && found.rest[0] != "catalog.xml")
        return sentence(404, "There are dataset.xml and stations.xml here.");
    const auto oldest = found.collection->oldest();
    if (!oldest) return query_error(oldest.error());
    return xml_answer(request, thredds_dataset_xml(request, *found.collection, *stations, *oldest));
}

Answer ThreddsDoor::file_answer(const Request& request,
                                const std::vector<std::string_view>& segments) const {
    const Found found = find(segments);
    if (!found.collection || request.path.ends_with('/'))
        return sentence(404, "There is no such file.");
    return found.collection->file(request, found.rest);
}

Answer ThreddsDoor::query_answer(const Request& request, ThreddsCollection& collection) const {
    if (request.parameter("station") == "all") {
        const auto stations = collection.stations();
        if (!stations) return query_error(stations.error());
        return xml_answer(request, thredds_stations_xml(*stations));
    }
    const auto query = read_thredds_query(request, now_utc());
    if (!query) return query_error(query.error());
    if (collection.needs_variable() && query->variables.empty())
        return sentence(200, "One or more variables are required, as in var=N0Q.");
    const auto files = files_of(collection, *query);
    if (!files) return query_error(files.error());
    return xml_answer(request,
                      thredds_result_xml(request, collection, text_of_query(request), *files));
}

Result<std::vector<ThreddsFile>> ThreddsDoor::files_of(ThreddsCollection& collection,
                                                       const ThreddsQuery& query) const {
    const auto stations = stations_meant(collection, query);
    if (!stations) return pass_on(stations);
    const std::vector<std::string> variables =
        collection.needs_variable() ? query.variables : std::vector<std::string>{""};
    const auto too_many = [&] {
        return fail(ErrorCode::bad_argument,
                    "The query has more than {} datasets: ask for fewer stations or times.",
                    options_.most_results);
    };
    const std::size_t looks =
        stations->size() * variables.size() * std::max<std::size_t>(1, query.times.size());
    if (looks > options_.most_results) return too_many();
    std::vector<ThreddsFile> files;
    for (const std::string& station : *stations) {
        for (const std::string& variable : variables) {
            for (const UtcTime time : query.times) {
                auto file = collection.nearest({station, variable}, time, nearest_within);
                if (!file) return pass_on(file);
                const bool is_new = *file && (files.empty() || files.back().path != (*file)->path);
                if (is_new) files.push_back(*std::move(*file));
            }
            if (!query.times.empty()) continue;
            RawRange range;
            range.from = query.from;
            range.to = query.to;
            range.most = options_.most_results - files.size() + 1;
            auto listed = collection.list({station, variable}, range);
            if (!listed) return pass_on(listed);
            std::ranges::move(*listed, std::back_inserter(files));
            if (files.size() > options_.most_results) return too_many();
        }
    }
    return files;
}

}  // namespace stormcellar::web
