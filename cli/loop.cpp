// stormcellar loop: the grids of a time range as animations.
#include <atomic>
#include <future>
#include <memory>
#include <optional>
#include <set>

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/version.h"
#include "cache/store.h"
#include "cli/commands.h"
#include "cli/follow.h"
#include "cli/interrupt.h"
#include "cli/kept_frames.h"
#include "cli/picture.h"
#include "cli/picture_plan.h"
#include "cli/progress.h"
#include "cli/query_options.h"
#include "cli/scene_file.h"
#include "cli/scene_options.h"
#include "render/animation/animation.h"
#include "render/map/map_layer.h"
#include "render/products/product.h"

namespace stormcellar::cli {
namespace {

struct LoopOptions : LoopSettings {
    std::string cache;
    SceneFile scene_file;
    FollowOptions follow;
    bool json = false;
    bool quiet = false;
    SceneOptions scene;
    PicturePlanOptions plan;
    KeptFrames* kept = nullptr;  // of a loop that is followed
};

struct Skipped {
    std::filesystem::path path;
    std::string reason;
};

struct LoopReport {
    std::size_t frames = 0;
    std::vector<Skipped> skipped;
    UtcTime from, to;  // of the frames that were drawn
    double read_s = 0, render_s = 0, encode_s = 0, total_s = 0;
    bool interrupted = false;
};

using Writers = std::vector<std::unique_ptr<render::AnimationWriter>>;

Result<Writers> make_writers(const LoopOptions& options) {
    Writers writers;
    for (const std::string& output : options.outputs) {
        auto writer = render::AnimationWriter::create(output, options.animation);
        if (!writer) return pass_on(writer);
        writers.push_back(std::move(*writer));
    }
    return writers;
}

// Encodes one frame behind the one that is being drawn, each writer on a thread of its own.
class Encoding {
  public:
    explicit Encoding(Writers writers) : writers_(std::move(writers)) {}

    // Takes the frame; gives the outcome of the one before.
    Status add(render::Image frame) {
        if (auto before = wait(); !before) return before;
        frame_ = std::move(frame);
        for (const auto& writer : writers_) {
            running_.push_back(std::async(std::launch::async, [this, &writer]() -> Timed {
                const auto start = Clock::now();
                auto status = writer->add(frame_);
                return {std::move(status), seconds_since(start)};
            }));
        }
        return {};
    }

    // Stops before the next file when the flag is set.
    Status finish(const std::atomic<bool>& stop) {
        if (auto before = wait(); !before) return before;
        const auto start = Clock::now();
        for (const auto& writer : writers_) {
            if (stop) return {};
            if (auto finished = writer->finish(); !finished) return finished;
        }
        encode_s_ += seconds_since(start);
        return {};
    }

    // Summed over the writers; after finish().
    [[nodiscard]] double encode_s() const { return encode_s_; }

  private:
    struct Timed {
        Status status;
        double seconds = 0;
    };
    // The first error, when all are done.
    Status wait() {
        Status outcome;
        for (auto& running : running_) {
            auto done = running.get();
            encode_s_ += done.seconds;
            if (outcome && !done.status) outcome = std::move(done.status);
        }
        running_.clear();
        return outcome;
    }

    Writers writers_;
    render::Image frame_;
    double encode_s_ = 0;
    std::vector<std::future<Timed>> running_;  // the last member: waited for before the rest goes
};

// What the frames of a loop share; how exactly they are drawn is planned for the first.
struct Drawing {
    render::Scene scene;
    render::MapKeeper map;
    bool is_planned = false;
};

// One frame; none when the grid's file is damaged, which is noted.
Result<std::optional<render::Image>> draw(const cache::StoreEntry& entry,
                                          const LoopOptions& options, Drawing& drawing,
                                          LoopReport& report) {
    const auto start = Clock::now();
    const auto file = cache::GridFile::open(entry.path);
    report.read_s += seconds_since(start);
    if (!file) {
        report.skipped.push_back({entry.path, file.error().message});
        return std::optional<render::Image>{};
    }
    const auto opened = Clock::now();
    const auto facts = facts_of(options.domain, file->description(), options.scene.time_zone);
    const int threads = thread_count(options.scene);
    if (!drawing.is_planned) {
        if (auto planned = plan_picture(file->view(), facts, options.plan, options.json, threads,
                                        drawing.scene);
            !planned) {
            return pass_on(planned);
        }
        drawing.is_planned = true;
    }
    const auto render = [&] {
        return render::render_frame(file->view(), facts, drawing.scene, threads, &drawing.map);
    };
    auto picture = options.kept ? options.kept->frame(entry.path, drawing.scene, render) : render();
    report.render_s += seconds_since(opened);
    if (!picture) return pass_on(picture);
    if (const Status whole = file->check_whole(); !whole) {  // cut while it was drawn
        report.skipped.push_back({entry.path, whole.error().message});
        return std::optional<render::Image>{};
    }
    if (report.frames == 0) report.from = report.to = entry.time;
    report.to = std::max(report.to, entry.time);
    ++report.frames;
    return std::optional{std::move(*picture)};
}

void warn_skipped(const Skipped& skipped) {
    fmt::print(stderr, "stormcellar: warning: frame left out: {}\n", printable(skipped.reason));
}

Status draw_all(const std::vector<cache::StoreEntry>& entries, const LoopOptions& options,
                const render::Scene& scene, const std::atomic<bool>& stop, Encoding& encoding,
                LoopReport& report) {
    Progress progress("frames", entries.size(), !options.quiet);
    Drawing drawing{scene, {}};
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (stop) return {};
        drawing.scene.camera.azimuth_deg =
            scene.camera.azimuth_deg +
            options.orbit_deg * static_cast<double>(i) / static_cast<double>(entries.size());
        auto picture = draw(entries[i], options, drawing, report);
        if (!picture) return pass_on(picture);
        if (*picture) {
            if (auto added = encoding.add(std::move(**picture)); !added) return added;
        } else {
            progress.clear();
            warn_skipped(report.skipped.back());
        }
        progress.show(i + 1);
    }
    return {};
}

Result<LoopReport> make_loop(const std::vector<cache::StoreEntry>& entries,
                             const LoopOptions& options, const render::Scene& scene,
                             const std::atomic<bool>& stop, Clock::time_point start) {
    auto writers = make_writers(options);
    if (!writers) return pass_on(writers);
    Encoding encoding(std::move(*writers));
    LoopReport report;
    if (auto drawn = draw_all(entries, options, scene, stop, encoding, report); !drawn) {
        return pass_on(drawn);
    }
    if (!stop) {
        if (report.frames == 0) {
            return fail(ErrorCode::corrupt, "{}: each of the {} grids is damaged; nothing written",
                        options.cache, entries.size());
        }
        if (auto finished = encoding.finish(stop); !finished) return pass_on(finished);
        report.encode_s = encoding.encode_s();
    }
    report.interrupted = stop;
    report.total_s = seconds_since(start);
    return report;
}

// What the file says of itself. The first grid stands for the method of all.
std::vector<std::pair<std::string, std::string>> metadata_of(
    const std::vector<cache::StoreEntry>& entries, const LoopOptions& options,
    const render::Scene& scene) {
    std::vector<std::pair<std::string, std::string>> metadata{
        {"Title", fmt::format("{} {} to {}", ascii(options.domain),
                              format_utc(entries.front().time), format_utc(entries.back().time))}};
    std::string description = render::product_title(scene);
    if (const auto first = cache::GridFile::open(entries.front().path)) {
        const auto& provenance = first->description().provenance;
        description += fmt::format("; gridded by {}, {}; stations {}", provenance.method,
                                   provenance.beam_model, fmt::join(provenance.stations, " "));
    }
    metadata.emplace_back("Description", ascii(description));
    metadata.emplace_back("Software", fmt::format("stormcellar {}", software_version));
    return metadata;
}

void print_report(const LoopOptions& options, const render::Scene& scene,
                  const LoopReport& report) {
    if (!options.json) {
        if (options.quiet) return;
        fmt::print(stderr, "{}: {} {} to {}, {}, {} frames of {} x {} pixels, {:.1f} s\n",
                   printable(fmt::format("{}", fmt::join(options.outputs, ", "))),
                   printable(options.domain), format_utc(report.from), format_utc(report.to),
                   options.scene.product, report.frames, scene.width, scene.height, report.total_s);
        return;
    }
    auto skipped = nlohmann::json::array();
    for (const Skipped& grid : report.skipped) {
        skipped.push_back({{"path", grid.path.native()}, {"reason", grid.reason}});
    }
    (options.follow.wanted ? print_json_line : print_json)({{"outputs", options.outputs},
                                                            {"domain", options.domain},
                                                            {"product", options.scene.product},
                                                            {"moment", options.scene.moment},
                                                            {"from", format_utc(report.from)},
                                                            {"to", format_utc(report.to)},
                                                            {"frames", report.frames},
                                                            {"skipped", skipped},
                                                            {"width", scene.width},
                                                            {"height", scene.height},
                                                            {"read_s", report.read_s},
                                                            {"render_s", report.render_s},
                                                            {"encode_s", report.encode_s},
                                                            {"total_s", report.total_s}});
}

Status check_outputs(const LoopOptions& options) {
    std::set<std::filesystem::path> names;
    for (const std::string& output : options.outputs) {
        if (!names.insert(std::filesystem::path(output).lexically_normal()).second) {
            return fail(ErrorCode::bad_argument, "{}: named twice as an output", output);
        }
    }
    return {};
}

std::string range_text(const LoopOptions& options) {
    std::string text;
    if (!options.range.from.empty()) text += fmt::format(" from {}", options.range.from);
    if (!options.range.to.empty()) text += fmt::format(" to {}", options.range.to);
    return text;
}

// Adds the way back, without the two ends.
void turn_back(std::vector<cache::StoreEntry>& entries) {
    for (std::size_t i = entries.size(); i > 2; --i) {
        const cache::StoreEntry entry = entries[i - 2];
        entries.push_back(entry);
    }
}

// The grids that are asked for, as of now.
Result<std::vector<cache::StoreEntry>> find_grids(const cache::Store& store,
                                                  const LoopOptions& options,
                                                  level2::Moment moment) {
    const auto range = parse_time_range(options.range);
    if (!range) return pass_on(range);
    auto entries = store.list(options.domain, moment, range->from, range->to);
    if (entries && options.last > 0 && entries->size() > options.last) {
        entries->erase(entries->begin(),
                       entries->end() - static_cast<std::ptrdiff_t>(options.last));
    }
    return entries;
}

// Gives the exit status. An interrupted loop that is followed is no failure.
int draw_loop(std::vector<cache::StoreEntry> entries, LoopOptions options,
              const render::Scene& scene, Interrupt& interrupt, Clock::time_point start) {
    options.animation.metadata = metadata_of(entries, options, scene);
    if (options.ping_pong) turn_back(entries);
    const auto report = make_loop(entries, options, scene, interrupt.flag(), start);
    if (!report) return report_error(report.error());
    if (report->interrupted) {
        if (options.follow.wanted) return exit_done;
        fmt::print(stderr, "stormcellar: interrupted; unfinished loops were not written\n");
        interrupt.end_by_signal();
        return exit_failed;
    }
    print_report(options, scene, *report);
    return exit_done;
}

int follow_loop(LoopOptions options, const render::Scene& scene, const cache::Store& store) {
    // What could never be written is refused before the first grid comes.
    if (const auto writers = make_writers(options); !writers) return report_error(writers.error());
    KeptFrames kept;
    options.kept = &kept;
    Interrupt interrupt;
    return follow({options.cache, options.domain, scene.moment,
                   [&] { return find_grids(store, options, scene.moment); },
                   [&](const auto& entries) {
                       kept.next_loop();
                       return draw_loop(entries, options, scene, interrupt, Clock::now());
                   },
                   options.quiet},
                  options.follow, interrupt.flag());
}

int run_loop(const LoopOptions& options) {
    const auto start = Clock::now();
    if (options.scene_file.error) return report_error(*options.scene_file.error);
    if (auto fine = check_outputs(options); !fine) return report_error(fine.error());
    const auto scene = scene_of(options.scene);
    if (!scene) return report_error(scene.error());
    const auto store = cache::Store::open_for_reading(options.cache);
    if (!store) return report_error(store.error());
    if (options.follow.wanted) return follow_loop(options, *scene, *store);
    auto entries = find_grids(*store, options, scene->moment);
    if (!entries) return report_error(entries.error());
    if (entries->empty())
        return report_no_grid(*store, options.domain, scene->moment, range_text(options));
    Interrupt interrupt;
    return draw_loop(std::move(*entries), options, *scene, interrupt, start);
}

}  // namespace

Command add_loop(CLI::App& app) {
    const auto options = std::make_shared<LoopOptions>();
    CLI::App* loop =
        app.add_subcommand("loop", "Draw the grids of a time range as a looping animation");
    loop->footer(
        "A grid file that is damaged is named on stderr and left out; the exit status is 0 when "
        "at least one frame was written.\n");
    add_scene_file(*loop, options->scene_file, options->scene, options->plan, options.get());
    loop->add_option("--cache", options->cache, "The cache's directory")->required();
    loop->add_option("DOMAIN,--domain", options->domain, "Whose grids; a station's is its ICAO")
        ->required();
    add_time_range(*loop, options->range);
    loop->add_option("--last", options->last, "Of these only the newest so many")
        ->check(CLI::Range(1, 1'000'000));
    loop->add_option("-o,--output", options->outputs,
                     fmt::format("{}; several times: the same frames to each",
                                 render::known_animation_endings()))
        ->required()
        ->take_all()
        ->expected(1)
        ->allow_extra_args(false);
    loop->add_option("--fps", options->animation.frames_per_second, "Frames a second, 0.1 to 60")
        ->capture_default_str();
    loop->add_option("--dwell", options->animation.last_frame_dwell_s,
                     "Seconds that the last frame stays longer, 0 to 60")
        ->capture_default_str();
    loop->add_option("--orbit", options->orbit_deg,
                     "Degrees that the camera goes round the grid over the loop; 360 closes it")
        ->check(CLI::Range(-3600.0, 3600.0))
        ->capture_default_str();
    loop->add_flag("--ping-pong", options->ping_pong,
                   "There and back: behind the last frame the others again, down to the second");
    add_follow_options(*loop, options->follow);
    loop->add_flag("--json", options->json,
                   "Say what was done as one JSON document; with --follow one a line");
    loop->add_flag("--quiet", options->quiet, "No progress and no summary; warnings and errors");
    add_scene_options(*loop, options->scene);
    add_picture_plan_options(*loop, options->plan);
    return {loop, [options] { return run_loop(*options); }};
}

}  // namespace stormcellar::cli
