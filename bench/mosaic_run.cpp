#include "bench/mosaic_run.h"

#include <algorithm>
#include <list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "bench/measure.h"
#include "bench/restamp.h"
#include "grid/plan/grid_effects.h"
#include "pipeline/mosaic/mosaic_frame.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/level2/decode.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;
using std::chrono::minutes;

constexpr minutes frame_interval{5};
constexpr minutes stretch{30};
// Longest time from a volume's start to the middle of the site's next volume.
constexpr minutes longest_wait{20};
const std::string domain_name = "bench";

pipeline::PartialOptions partial_options(const grid::GridSpec& domain, const std::string& icao) {
    const accuracy::Chain chain = grid::effects_of(level2::Moment::ref);
    const accuracy::Choice rungs = grid::default_choice(chain, domain, grid::beam_width_of(icao));
    pipeline::PartialOptions options;
    options.gridder.method = grid::scene_choice(chain, rungs).method;
    options.quantization = grid::default_quantization(level2::Moment::ref);
    return options;
}

class Runner {
  public:
    Runner(int sites, int threads, Beside beside, cache::StoreWriter store)
        : domain_(feed_domain(sites)),
          threads_(threads),
          beside_(beside),
          store_(std::move(store)),
          geometries_(2 * static_cast<std::size_t>(sites)) {}

    Status run(std::span<const FeedVolume> volumes, UtcTime until);
    [[nodiscard]] const MosaicRun& done() const { return done_; }

  private:
    // The result for one volume.
    struct Made {
        std::optional<pipeline::MadePartial> partial;
        std::uint64_t compressed = 0, uncompressed = 0;
    };

    void decompress_alone(std::span<const FeedVolume> volumes) const;
    Status make_partials(std::span<const FeedVolume> volumes);
    Result<Made> make_partial(const FeedVolume& volume);
    Status make_frames(UtcTime from, UtcTime until);
    void drop_before(UtcTime time);

    const grid::GridSpec domain_;
    const int threads_;
    const Beside beside_;
    cache::StoreWriter store_;
    pipeline::GeometryCache geometries_;
    std::list<pipeline::MadePartial> partials_;
    MosaicRun done_;
};

void Runner::decompress_alone(std::span<const FeedVolume> volumes) const {
    for_each_piece(static_cast<int>(volumes.size()), threads_, [&](int piece) {
        const auto bytes = read_file(volumes[static_cast<std::size_t>(piece)].file);
        if (!bytes) return;  // make_partial() reports this error
        Bytes peeled;
        decompress_all(ldm_records(*bytes, peeled));
    });
}

Result<Runner::Made> Runner::make_partial(const FeedVolume& volume) {
    const auto bytes = read_file(volume.file);
    if (!bytes) return pass_on(bytes);
    level2::DecodeOptions options;
    options.selection.moments = {level2::Moment::ref};
    auto decoded = level2::decode(*bytes, options);
    if (!decoded) return pass_on(decoded);
    move_times(decoded->volume, volume.moved);
    const auto site = site_of(decoded->volume);
    if (!site) return pass_on(site);
    auto made = pipeline::make_partial(decoded->volume, *site, domain_,
                                       partial_options(domain_, site->icao), geometries_);
    if (!made) return pass_on(made);
    if (*made) (*made)->description.provenance.source_files = {volume.file.filename().string()};
    return Made{std::move(*made), bytes->size(), decoded->report.message_bytes};
}

Status Runner::make_partials(std::span<const FeedVolume> volumes) {
    std::vector<std::optional<Result<Made>>> made(volumes.size());
    for_each_piece(static_cast<int>(volumes.size()), threads_, [&](int piece) {
        const auto at = static_cast<std::size_t>(piece);
        made[at].emplace(make_partial(volumes[at]));
    });
    for (auto& one : made) {
        if (!*one) return pass_on(*one);
        Made& good = **one;
        done_.size.add(good.compressed, good.uncompressed);
        ++done_.volumes;
        if (good.partial) partials_.push_back(std::move(*good.partial));
    }
    return {};
}

Status Runner::make_frames(UtcTime from, UtcTime until) {
    std::vector<pipeline::PartialView> views;
    for (const pipeline::MadePartial& partial : partials_)
        views.push_back({&partial.description, partial.bricks.view()});
    pipeline::FrameOptions options;
    options.threads = threads_;
    for (UtcTime instant = from; instant < until; instant += frame_interval) {
        const auto frame = pipeline::make_frame(domain_, views, instant, options, geometries_);
        if (!frame) return pass_on(frame);
        const auto committed =
            store_.commit(domain_name, frame->description, frame->mosaic.cells.view());
        if (!committed) return pass_on(committed);
        ++done_.frames;
    }
    return {};
}

UtcTime middle_of(const pipeline::MadePartial& partial) {
    return pipeline::PartialView{&partial.description, {}}.middle();
}

// Drops the partials that no frame from `time` on needs: for each site, all partials before `time`
// except the last of them.
void Runner::drop_before(UtcTime time) {
    std::map<std::string, UtcTime> last;
    for (const pipeline::MadePartial& partial : partials_) {
        const UtcTime middle = middle_of(partial);
        if (middle > time) continue;
        const auto at = last.try_emplace(partial.description.sites.front().icao, middle).first;
        at->second = std::max(at->second, middle);
    }
    partials_.remove_if([&](const pipeline::MadePartial& partial) {
        const auto at = last.find(partial.description.sites.front().icao);
        return at != last.end() && middle_of(partial) < at->second;
    });
}

Status Runner::run(std::span<const FeedVolume> volumes, UtcTime until) {
    UtcTime next_frame = feed_start() + frame_interval;
    std::size_t first = 0;
    for (UtcTime end = feed_start() + stretch; end <= until; end += stretch) {
        std::size_t last = first;
        while (last < volumes.size() && volumes[last].start < end)
            ++last;
        const auto here = volumes.subspan(first, last - first);
        first = last;
        const double before_s = cpu_s();
        if (beside_ == Beside::libbz2)
            done_.libbz2_s += seconds_of([&] { decompress_alone(here); });
        const double between_s = cpu_s();
        done_.libbz2_cpu_s += between_s - before_s;
        Status status;
        const double volumes_s = seconds_of([&] { status = make_partials(here); });
        if (!status) return status;
        const bool is_last = end + stretch > until;
        // Make the frames before this time, because no later file can bring a volume that they
        // need.
        const UtcTime ready = is_last ? until + minutes{1} : end - longest_wait;
        const double frames_s = seconds_of([&] {
            status = make_frames(next_frame, ready);
            while (next_frame < ready)
                next_frame += frame_interval;
            drop_before(next_frame);
        });
        if (!status) return status;
        done_.cpu_s += cpu_s() - between_s;
        done_.volumes_s += volumes_s;
        done_.total_s += volumes_s + frames_s;
    }
    return {};
}

}  // namespace

Result<MosaicRun> run_mosaic(int sites, int threads, const fs::path& feed, const fs::path& cache,
                             std::chrono::hours hours, FeedFiles files, Beside beside) {
    auto store = cache::StoreWriter::open(real_file_system(), cache, false);
    if (!store) return pass_on(store);
    Runner runner(sites, threads, beside, std::move(*store));
    const std::vector<FeedVolume> volumes = feed_of(sites, feed, hours, files);
    if (Status run = runner.run(volumes, feed_start() + hours); !run) return pass_on(run);
    return runner.done();
}

}  // namespace stormcellar::bench
