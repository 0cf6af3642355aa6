#include "web/doors/api/call.h"

#include <cmath>

#include "base/checksum.h"
#include "base/floating_point.h"
#include "base/parse_number.h"
#include "stormcellar/cache/grid_name.h"
#include "web/data/grids/text_answer.h"

namespace stormcellar::web {
namespace {

// A halved grid of the United States takes tens of megabytes.
constexpr std::size_t most_halved_kept = 4;
constexpr std::size_t most_shown_text = 80;
constexpr std::int64_t most_listed = 10'000, usually_listed = 100;

std::string shown(std::string_view text) {
    return std::string(text.substr(0, most_shown_text));
}

Result<double> bounded_number(std::string_view name, std::string_view text, double least,
                              double most) {
    const auto number = parse_number<double>(text);
    if (!number || !is_within(*number, least, most)) {
        return fail(ErrorCode::bad_argument, "{}: a number from {} to {}, not '{}'", name, least,
                    most, shown(text));
    }
    return *number;
}

}  // namespace

ApiState::ApiState(ApiSources sources)
    : sources_(std::move(sources)),
      catalog_(sources_.catalog, sources_.reader),
      halved_({.values = most_halved_kept}) {}

ApiState::Halved ApiState::find_halved(const std::string& key) {
    const MutexLock lock(mutex_);
    const Halved* found = halved_.find(key);
    return found == nullptr ? nullptr : *found;
}

void ApiState::keep_halved(const std::string& key, const Halved& halved) {
    const MutexLock lock(mutex_);
    halved_.keep(key, halved);
}

ApiState::DecodedVolume ApiState::find_volume(const std::string& key) {
    const MutexLock lock(mutex_);
    return key == volume_key_ ? volume_ : nullptr;
}

void ApiState::keep_volume(const std::string& key, DecodedVolume volume) {
    const MutexLock lock(mutex_);
    volume_key_ = key;
    volume_ = std::move(volume);
}

Answered<Kept> kept_or_made(const ApiCall& call, const std::string& key,
                            const std::function<Result<Kept>()>& make) {
    KeptAnswers& answers = *call.state.sources().kept;
    if (auto kept = answers.find(key)) return std::move(*kept);
    if (call.must_be_quick) return refuse(takes_long());
    auto made = answers.find_or_make(key, make);
    if (!made) return refuse(made.error());
    return std::move(*made);
}

Result<Kept> kept_compressed(std::string_view bytes, Coding coding) {
    auto sent = compressed(bytes, coding);
    if (!sent) return pass_on(sent);
    std::string etag = fmt::format("\"{:016x}-{}\"", xxh3_64(std::as_bytes(std::span(bytes))),
                                   coding_name(coding));
    return Kept{text_of(std::move(*sent)), std::move(etag), std::string(coding_name(coding))};
}

Entity entity_of(const Kept& kept, std::string content_type) {
    Entity entity;
    entity.bytes = {kept.bytes};
    entity.content_type = std::move(content_type);
    entity.etag = kept.etag;
    entity.coding = kept.notes;
    entity.varies = true;
    return entity;
}

std::string ApiCall::path_value(std::string_view name) const {
    for (const auto& [key, value] : path_values) {
        if (key == name) return value;
    }
    return {};
}

Result<std::optional<double>> number_parameter(const ApiCall& call, std::string_view name,
                                               double least, double most) {
    const auto text = call.request.parameter(name);
    if (!text) return std::optional<double>{};
    const auto number = bounded_number(name, *text, least, most);
    if (!number) return pass_on(number);
    return std::optional(*number);
}

Result<std::int64_t> whole_parameter(const ApiCall& call, std::string_view name, std::int64_t least,
                                     std::int64_t most, std::int64_t usual) {
    const auto text = call.request.parameter(name);
    if (!text) return usual;
    const auto number = parse_number<std::int64_t>(*text);
    if (!number || *number < least || *number > most) {
        return fail(ErrorCode::bad_argument, "{}: a whole number from {} to {}, not '{}'", name,
                    least, most, shown(*text));
    }
    return *number;
}

Result<std::optional<UtcTime>> time_parameter(const ApiCall& call, std::string_view name) {
    const auto text = call.request.parameter(name);
    if (!text) return std::optional<UtcTime>{};
    const auto time = parse_utc(*text, now_utc());
    if (!time) return fail(ErrorCode::bad_argument, "{}: {}", name, time.error().message);
    return std::optional(*time);
}

Result<std::optional<level2::Moment>> moment_parameter(const ApiCall& call) {
    const auto text = call.request.parameter("moment");
    if (!text) return std::optional<level2::Moment>{};
    const auto moment = level2::moment_from_name(*text);
    if (!moment) {
        return fail(ErrorCode::bad_argument, "moment: {}, not '{}'",
                    level2::moment_names(", ", " or "), shown(*text));
    }
    return moment;
}

Result<RegionBox> box_parameters(const ApiCall& call) {
    RegionBox box;
    struct Side {
        std::string_view name;
        double* to;
        double most;
    };
    for (const Side& side : {Side{"west", &box.west_deg, 540}, Side{"south", &box.south_deg, 90},
                             Side{"east", &box.east_deg, 540}, Side{"north", &box.north_deg, 90}}) {
        const auto number = number_parameter(call, side.name, -side.most, side.most);
        if (!number) return pass_on(number);
        if (!*number) {
            return fail(ErrorCode::bad_argument, "{}: the parameter is missing", side.name);
        }
        *side.to = **number;
    }
    return box;
}

Result<ListedRange> range_parameters(const ApiCall& call) {
    const auto from = time_parameter(call, "from");
    if (!from) return pass_on(from);
    const auto to = time_parameter(call, "to");
    if (!to) return pass_on(to);
    const auto limit = whole_parameter(call, "limit", 1, most_listed, usually_listed);
    if (!limit) return pass_on(limit);
    return ListedRange{*from, *to, static_cast<std::size_t>(*limit)};
}

Result<grid::GeoPoint> place_parameter(const ApiCall& call, std::string_view name) {
    const auto text = call.request.parameter(name);
    if (!text) {
        return fail(ErrorCode::bad_argument, "{}: the parameter is missing: LATITUDE,LONGITUDE",
                    name);
    }
    const std::size_t comma = text->find(',');
    if (comma == std::string_view::npos) {
        return fail(ErrorCode::bad_argument, "{}: LATITUDE,LONGITUDE in degrees, not '{}'", name,
                    shown(*text));
    }
    const auto latitude = bounded_number(name, text->substr(0, comma), -90, 90);
    if (!latitude) return pass_on(latitude);
    const auto longitude = bounded_number(name, text->substr(comma + 1), -180, 180);
    if (!longitude) return pass_on(longitude);
    return grid::GeoPoint{*latitude, *longitude};
}

Result<std::pair<std::size_t, std::size_t>> range_of_text(std::string_view name,
                                                          std::string_view text) {
    const std::size_t dash = text.find('-');
    const auto first = parse_number<std::uint32_t>(text.substr(0, dash));
    const auto last =
        dash == std::string_view::npos ? first : parse_number<std::uint32_t>(text.substr(dash + 1));
    if (!first || !last || *first > *last) {
        return fail(ErrorCode::bad_argument, "{}: FIRST-LAST, not '{}'", name, shown(text));
    }
    return std::pair<std::size_t, std::size_t>(*first, *last);
}

Answer missing_grid(Grids& grids, const NamedGrid& named) {
    const std::string what = fmt::format("the grid of {}, {}, at {}", shown(named.domain),
                                         level2::moment_name(named.moment), format_utc(named.time));
    if (grids.was_evicted(named.domain, named.moment, named.time)) {
        return json_error(410, what + " was evicted from the cache");
    }
    return json_error(404, what + " is not in the cache");
}

Answered<NamedGrid> named_grid(const ApiCall& call) {
    if (!call.state.sources().grids) return refuse(json_error(404, "no cache is served"));
    NamedGrid named;
    named.domain = call.path_value("domain");
    const std::string moment_text = call.path_value("moment");
    const auto moment = level2::moment_from_name(moment_text);
    if (!moment) {
        return refuse(json_error(404, "there is no moment '" + shown(moment_text) + "': it is " +
                                          level2::moment_names(", ", " or ")));
    }
    named.moment = *moment;
    const std::string time_text = call.path_value("time");
    if (time_text == "latest") {
        const auto newest = call.grids().newest(named.domain, named.moment);
        if (!newest) {
            return refuse(json_error(404, fmt::format("there is no grid of {} in '{}'", moment_text,
                                                      shown(named.domain))));
        }
        named.time = *newest;
        return named;
    }
    const auto time = parse_utc(time_text, now_utc());
    if (!time) return refuse(json_error(400, "time: " + time.error().message));
    named.time = *time;
    return named;
}

Answered<std::shared_ptr<const OpenGrid>> find_grid(const ApiCall& call) {
    const auto named = named_grid(call);
    if (!named) return refuse(named.error());
    auto found = call.grids().find(named->domain, named->moment, named->time);
    if (found) return std::move(*found);
    if (found.error().code == ErrorCode::not_found) {
        return refuse(missing_grid(call.grids(), *named));
    }
    return refuse(found.error());
}

Answer json_answer(const Request& request, const ApiJson& document) {
    // Names in files may hold any bytes.
    return text_answer_to(request, "application/json",
                          document.dump(-1, ' ', false, ApiJson::error_handler_t::replace) + "\n");
}

Answer takes_long() {
    Answer answer;
    answer.status = 0;
    return answer;
}

std::string grid_path(const NamedGrid& grid) {
    return fmt::format("/api/v1/grids/{}/{}/{}", grid.domain, level2::moment_name(grid.moment),
                       format_utc(grid.time));
}

}  // namespace stormcellar::web
