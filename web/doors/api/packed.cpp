// Operations that return the packed form of whole grids, of parts of large grids, of halved grids,
// and of grids between volumes.
#include "base/checksum.h"
#include "grid/cells/cut_bricks.h"
#include "pipeline/mosaic/between_grids.h"
#include "web/data/grids/compressed.h"
#include "web/data/grids/halved_grid.h"
#include "web/data/grids/packed_grid.h"
#include "web/data/grids/region.h"
#include "web/doors/api/operations.h"
#include "web/doors/pictures/picture_answers.h"

namespace stormcellar::web {
namespace {

constexpr std::chrono::seconds a_year{31'536'000};
constexpr int threads_of_a_computation = 1;

// A range of columns of bricks. Both ends are included.
struct BrickWindow {
    std::size_t first_x = 0, last_x = 0, first_y = 0, last_y = 0;
};

// The part of a grid that a request asks for, and its form.
struct PackedRequest {
    PackedPart part = PackedPart::whole;
    std::size_t first = 0, end = 0;     // of `bricks`
    std::optional<std::uint64_t> most;  // in bytes; a larger whole grid is sent as its table
    bool values_alone = false;          // codes of values only, for a whole grid
    std::optional<BrickWindow> window;  // in bricks of the grid after halving
    int half = 0;
    std::optional<HalvedBy> by;
    std::optional<std::string> id;
    Coding coding = Coding::identity;

    // Returns a text for keys, which no other answer about the same grid has.
    [[nodiscard]] std::string text() const {
        const std::string cut = window
                                    ? fmt::format("-w{}-{}-{}-{}", window->first_x, window->last_x,
                                                  window->first_y, window->last_y)
                                    : "";
        return fmt::format("{}-{}-{}-{}{}{}-{}{}{}{}", static_cast<unsigned>(part), first, end,
                           most.value_or(0), values_alone ? "v" : "", cut, half,
                           by ? halved_by_name(*by) : "", coding == Coding::identity ? "" : "-",
                           coding_name(coding));
    }
};

Status read_part(const ApiCall& call, PackedRequest& wanted) {
    const auto part = call.request.parameter("part");
    const auto bricks = call.request.parameter("bricks");
    if (part && bricks) {
        return fail(ErrorCode::bad_argument, "part and bricks cannot be asked for at once");
    }
    if (part && *part == "table") {
        wanted.part = PackedPart::table;
    } else if (part && *part != "whole") {
        return fail(ErrorCode::bad_argument, "part: whole or table");
    }
    if (call.request.parameter("most")) {
        if (part || bricks) {
            return fail(ErrorCode::bad_argument,
                        "most is of a whole grid: not of a part or bricks");
        }
        const auto most = whole_parameter(call, "most", 1, most_packed_bytes, 1);
        if (!most) return pass_on(most);
        wanted.most = static_cast<std::uint64_t>(*most);
    }
    if (!bricks) return {};
    const auto range = range_of_text("bricks", *bricks);
    if (!range) return pass_on(range);
    wanted.part = PackedPart::bricks;
    wanted.first = range->first;
    wanted.end = range->second + 1;
    return {};
}

// Reads "FIRST-LAST,FIRST-LAST": the range of bricks from west to east, and the range from south to
// north.
Status read_window(const ApiCall& call, PackedRequest& wanted) {
    const auto text = call.request.parameter("window");
    if (!text) return {};
    if (wanted.part != PackedPart::whole || wanted.most) {
        return fail(ErrorCode::bad_argument,
                    "window is of a whole grid: not of a part, bricks or most");
    }
    const std::size_t comma = text->find(',');
    if (comma == std::string_view::npos) {
        return fail(ErrorCode::bad_argument,
                    "window: FIRST-LAST,FIRST-LAST, to the east and to the north");
    }
    const auto x = range_of_text("window", text->substr(0, comma));
    if (!x) return pass_on(x);
    const auto y = range_of_text("window", text->substr(comma + 1));
    if (!y) return pass_on(y);
    wanted.window = BrickWindow{x->first, x->second, y->first, y->second};
    return {};
}

Result<PackedRequest> read_request(const ApiCall& call) {
    PackedRequest wanted;
    if (Status read = read_part(call, wanted); !read) return pass_on(read);
    if (Status read = read_window(call, wanted); !read) return pass_on(read);
    const auto half = whole_parameter(call, "half", 0, most_halvings, 0);
    if (!half) return pass_on(half);
    wanted.half = static_cast<int>(*half);
    if (const auto by = call.request.parameter("by")) {
        wanted.by = halved_by_from_name(*by);
        if (!wanted.by) return fail(ErrorCode::bad_argument, "by: maximum or mean");
    }
    if ((wanted.half > 0) != wanted.by.has_value()) {
        return fail(ErrorCode::bad_argument,
                    "half and by go together: cells are halved by maximum or mean");
    }
    if (const auto codes = call.request.parameter("codes")) {
        if (*codes != "all" && *codes != "values") {
            return fail(ErrorCode::bad_argument, "codes: all or values");
        }
        wanted.values_alone = *codes == "values";
    }
    if (wanted.values_alone && wanted.part != PackedPart::whole) {
        return fail(ErrorCode::bad_argument, "codes=values is of a whole grid");
    }
    if (const auto id = call.request.parameter("id")) wanted.id = std::string(*id);
    wanted.coding = coding_for(call.request);
    return wanted;
}

std::string key_of(const OpenGrid& grid, const PackedRequest& wanted) {
    return fmt::format("packed/{}/{}/{}/{}/{}", grid.domain, level2::moment_name(grid.moment),
                       format_utc(grid.time), grid.id, wanted.text());
}

Result<std::string> pack(const PackedSource& source, const PackedRequest& wanted) {
    switch (wanted.part) {
        case PackedPart::table:
            return pack_table(source);
        case PackedPart::bricks:
            return pack_bricks(source, wanted.first, wanted.end);
        case PackedPart::whole:
            break;
    }
    return wanted.most ? pack_whole_or_table(source, *wanted.most) : pack_whole(source);
}

Result<Kept> compress_packed(const Result<std::string>& bytes, Coding coding, std::string etag) {
    if (!bytes) return pass_on(bytes);
    auto sent = compressed(*bytes, coding);
    if (!sent) return pass_on(sent);
    return Kept{text_of(std::move(*sent)), std::move(etag), std::string(coding_name(coding))};
}

std::string halved_key(const OpenGrid& grid, int half, HalvedBy by) {
    return fmt::format("{}/{}/{}/{}/{}/{}", grid.domain, level2::moment_name(grid.moment),
                       format_utc(grid.time), grid.id, half, halved_by_name(by));
}

Result<ApiState::Halved> find_or_halve(ApiState& state, const OpenGrid& grid,
                                       const PackedRequest& wanted) {
    const std::string key = halved_key(grid, wanted.half, *wanted.by);
    if (auto kept = state.find_halved(key)) return kept;
    auto made = halved(grid.file.view(), grid.moment, wanted.half, *wanted.by);
    if (made) state.keep_halved(key, *made);
    return made;
}

// Cuts out the window. Errors: bad_argument if the window is outside the grid, or has more bricks
// than one answer may have.
Result<grid::BrickGrid> cut(const grid::BrickView& view, const BrickWindow& window) {
    const auto columns_x = static_cast<std::size_t>(view.bricks_x);
    const auto columns_y = static_cast<std::size_t>(view.bricks_y);
    if (window.last_x >= columns_x || window.last_y >= columns_y) {
        return fail(ErrorCode::bad_argument, "window: the grid has the columns of bricks 0-{},0-{}",
                    columns_x - 1, columns_y - 1);
    }
    const std::size_t bricks = (window.last_x - window.first_x + 1) *
                               (window.last_y - window.first_y + 1) *
                               static_cast<std::size_t>(view.bricks_z);
    if (bricks > most_bricks_of_a_range) {
        return fail(ErrorCode::bad_argument,
                    "window: at most {} bricks are sent at once, not {}: ask for half=1 or more",
                    most_bricks_of_a_range, bricks);
    }
    const auto cell = [](std::size_t brick) { return static_cast<int>(brick) * grid::brick_edge; };
    const int first_x = cell(window.first_x), first_y = cell(window.first_y);
    return grid::cut_bricks(
        view, {first_x, first_y, std::min(view.spec->nx, cell(window.last_x + 1)) - first_x,
               std::min(view.spec->ny, cell(window.last_y + 1)) - first_y});
}

Result<Kept> make_packed(ApiState& state, const OpenGrid& grid, const PackedRequest& wanted) {
    PackedSource source{&grid.file.description(), grid.file.view(), grid.file.checksum()};
    source.values_alone = wanted.values_alone;
    ApiState::Halved half;
    if (wanted.half > 0) {
        auto made = find_or_halve(state, grid, wanted);
        if (!made) return pass_on(made);
        half = std::move(*made);
        source.view = half->view();
        source.halved = static_cast<std::uint32_t>(wanted.half);
        source.halved_by = static_cast<std::uint32_t>(*wanted.by);
    }
    std::optional<grid::BrickGrid> window;
    if (wanted.window) {
        auto made = cut(source.view, *wanted.window);
        if (!made) return pass_on(made);
        window = std::move(*made);
        source.view = window->view();
    }
    const auto bytes = pack(source, wanted);
    // If the file was truncated while we read it, missing codes read as 0 (not seen), so check that
    // the file is still whole.
    if (Status whole = grid.file.check_whole(); !whole) return pass_on(whole);
    return compress_packed(bytes, wanted.coding, fmt::format("\"{}-{}\"", grid.id, wanted.text()));
}

Answer packed_answer(const Request& request, const Kept& kept,
                     std::optional<std::chrono::seconds> max_age = {}) {
    Entity entity = entity_of(kept, "application/octet-stream");
    entity.max_age = max_age;
    entity.never_changes = max_age == a_year;
    return answer_with(request, std::move(entity));
}

// Returns how long clients may reuse the answer. Bytes requested by id never change. Bytes
// requested by time may be reused as long as a picture.
std::optional<std::chrono::seconds> max_age_of_packed(const ApiCall& call,
                                                      const PackedRequest& wanted,
                                                      const OpenGrid& grid) {
    return wanted.id ? a_year : max_age_of(call.path_value("time"), grid);
}

Answer other_id(const OpenGrid& grid) {
    return json_error(410, "the grid was made again; its id is now " + grid.id);
}

// Packs a mosaic that was made on request and has no file.
Result<Kept> pack_frame(const pipeline::MosaicFrame& frame, Coding coding, PackedSource source) {
    source.description = &frame.description;
    source.view = frame.mosaic.cells.view();
    auto bytes = pack_whole(source);
    if (!bytes) return pass_on(bytes);
    // There is no file that has an id, so compute the id from the bytes.
    const std::uint64_t id = xxh3_64(std::as_bytes(std::span(*bytes)));
    std::memcpy(bytes->data() + offsetof(PackedHeader, id), &id, sizeof id);
    return compress_packed(bytes, coding, fmt::format("\"{:016x}-{}\"", id, coding_name(coding)));
}

Result<Kept> make_between(const ApiCall& call, const NamedGrid& named, Coding coding) {
    const auto store = cache::StoreReader::open(call.grids().cache());
    if (!store) return pass_on(store);
    pipeline::BetweenOptions options;
    options.from = options.to = named.time;
    options.threads = threads_of_a_computation;
    std::vector<std::string> problems;
    auto between =
        pipeline::BetweenGrids::open(*store, named.domain, named.moment, options, problems);
    if (!between) return pass_on(between);
    const auto frame = between->at(named.time);
    if (!frame) return pass_on(frame);
    if (!*frame) {
        return fail(ErrorCode::not_found,
                    "there are no two volumes of {}, near enough to each other, between whose "
                    "middles {} lies",
                    named.domain, format_utc(named.time));
    }
    return pack_frame(**frame, coding, {});
}

}  // namespace

std::optional<Answer> api_packed_at_once(const ApiCall& call) {
    const auto named = named_grid(call);
    if (!named) return std::nullopt;
    const auto grid = call.grids().find_if_open(named->domain, named->moment, named->time);
    const auto wanted = read_request(call);
    if (!grid || !wanted) return std::nullopt;
    if (wanted->id && *wanted->id != grid->id) return other_id(*grid);
    const auto kept = call.state.sources().kept->find(key_of(*grid, *wanted));
    if (!kept) return std::nullopt;
    return packed_answer(call.request, *kept, max_age_of_packed(call, *wanted, *grid));
}

Answer api_packed(const ApiCall& call) {
    const auto wanted = read_request(call);
    if (!wanted) return json_error(wanted.error());
    const auto grid = find_grid(call);
    if (!grid) return grid.error();
    if (wanted->id && *wanted->id != (*grid)->id) return other_id(**grid);
    KeptAnswers& answers = *call.state.sources().kept;
    const std::string key = key_of(**grid, *wanted);
    auto kept = answers.find(key);
    if (!kept) {
        const bool halves = wanted->half > 0 &&
                            !call.state.find_halved(halved_key(**grid, wanted->half, *wanted->by));
        if (halves && call.must_be_quick) return takes_long();
        auto made =
            answers.find_or_make(key, [&] { return make_packed(call.state, **grid, *wanted); });
        if (!made) return json_error(made.error());
        kept = std::move(*made);
    }
    return packed_answer(call.request, *kept, max_age_of_packed(call, *wanted, **grid));
}

Answer api_between(const ApiCall& call) {
    const auto named = named_grid(call);
    if (!named) return named.error();
    const std::string_view group = cache::group_of(named->domain);
    if (!cache::is_domain_name(named->domain) || call.grids().moments(named->domain).empty()) {
        return json_error(404, "there is no such domain");
    }
    const Coding coding = coding_for(call.request);
    // The answer may change when anything in the domain changes, so the key includes the count of
    // changes.
    const std::string key =
        fmt::format("between/{}/{}/{}/{}/{}", named->domain, level2::moment_name(named->moment),
                    format_utc(named->time), call.grids().changes_of(group), coding_name(coding));
    const auto kept = kept_or_made(call, key, [&] { return make_between(call, *named, coding); });
    if (!kept) return kept.error();
    return packed_answer(call.request, *kept);
}

Answer api_region_packed(const ApiCall& call) {
    const auto asked = asked_region(call);
    if (!asked) return asked.error();
    const auto time = parse_utc(call.path_value("time"), now_utc());
    if (!time) return json_error(404, time.error().message);
    const Coding coding = coding_for(call.request);
    std::string key =
        fmt::format("region/{}/{}/{}/{}", asked->name, level2::moment_name(asked->plan.moment),
                    format_utc(*time), coding_name(coding));
    // The answer may change when the grids of a site change, so the key includes each site's count
    // of changes.
    for (const std::string& site : asked->plan.sites)
        key += fmt::format("/{}", call.grids().changes_of(site));
    const auto kept = kept_or_made(call, key, [&]() -> Result<Kept> {
        const auto frame = make_region(call.grids(), asked->plan, *time);
        if (!frame) return pass_on(frame);
        PackedSource source;
        source.halved = static_cast<std::uint32_t>(asked->plan.halvings);
        source.halved_by = source.halved > 0 ? static_cast<std::uint32_t>(HalvedBy::maximum) : 0;
        return pack_frame(*frame, coding, source);
    });
    if (!kept) return kept.error();
    return packed_answer(call.request, *kept);
}

}  // namespace stormcellar::web
