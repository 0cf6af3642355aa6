#include "fetch/pull/pull_service.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "service/log.h"

namespace stormcellar::pull {
namespace {

constexpr std::chrono::milliseconds longest_wait{1000};

}  // namespace

PullService::PullService(FileSystem& file_system, PullConfig config)
    : file_system_(file_system), config_(std::move(config)) {}

Result<std::unique_ptr<PullService>> PullService::open(FileSystem& file_system,
                                                       const PullConfig& config) {
    std::unique_ptr<PullService> service(new PullService(file_system, config));
    std::error_code error;
    std::filesystem::create_directories(config.directory, error);
    if (error) return fail(ErrorCode::io, "{}: {}", config.directory.native(), error.message());
    if (Status swept = remove_temporaries(file_system, config.directory); !swept)
        return pass_on(swept);
    for (const PullSource& source : config.sources) {
        auto grids = PulledGrids::open(file_system, config.directory / source.name,
                                       {config.bytes_a_source, config.age});
        if (!grids) return pass_on(grids);
        service->pullers_.push_back(
            std::make_unique<SourcePuller>(source, config, std::move(*grids), service->stop_));
    }
    for (const auto& puller : service->pullers_)
        service->threads_.emplace_back([&of = *service, &own = *puller] { of.run(own); });
    return service;
}

PullService::~PullService() {
    {
        const MutexLock lock(mutex_);
        stop_ = true;
    }
    stopped_.notify_all();
    for (std::thread& thread : threads_)
        thread.join();
}

// Runs the turns of a machine. Logs when they begin to fail, and when they succeed again.
void PullService::run(SourcePuller& puller) {
    bool was_failing = false;
    while (!stop_) {
        const Status done = puller.turn();
        const std::string& name = puller.source().name;
        if (!done && !was_failing) say(LogLevel::warning, "{}: {}", name, done.error().message);
        if (done && was_failing) say(LogLevel::info, "{}: answers again", name);
        was_failing = !done;
        wait(puller);
    }
}

void PullService::wait(SourcePuller& puller) {
    const SteadyTime end = steady_now() + puller.pause();
    const MutexLock lock(mutex_);
    while (!stop_ && steady_now() < end) {
        puller.beat();
        stopped_.wait_until(mutex_, std::min(end, steady_now() + longest_wait));
    }
}

std::vector<SourceStatus> PullService::status() const {
    std::vector<SourceStatus> all;
    for (const auto& puller : pullers_)
        all.push_back(puller->status());
    return all;
}

Status PullService::publish() {
    const auto sources = status();
    std::string text = status_text(sources, UtcTime{});
    if (text == published_) return {};
    const std::string dated = status_text(sources, now_utc());
    Status written = write_file_atomically(file_system_, config_.directory / "status.json",
                                           std::as_bytes(std::span(dated.data(), dated.size())));
    if (written) published_ = std::move(text);
    return written;
}

std::chrono::milliseconds PullService::longest_silence() const {
    auto longest = SteadyTime::duration::zero();
    for (const auto& puller : pullers_)
        longest = std::max(longest, steady_now() - puller->last_beat());
    return std::chrono::duration_cast<std::chrono::milliseconds>(longest);
}

}  // namespace stormcellar::pull
