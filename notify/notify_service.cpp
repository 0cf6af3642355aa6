#include "notify/notify_service.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "base/counted.h"
#include "notify/notice.h"
#include "notify/sender.h"
#include "service/log.h"

namespace stormcellar::notify {
namespace {

constexpr std::chrono::milliseconds between_steps{1000};
constexpr std::chrono::seconds longest_turn{20};
// Settled messages are kept for this long after the time in which they limit other messages.
constexpr std::chrono::hours kept_longer{1};

}  // namespace

struct NotifyService::Post {
    explicit Post(NotifyRule its_rule) : rule(std::move(its_rule)) {}
    const NotifyRule rule;
    std::unique_ptr<Outbox> outbox;
    std::unique_ptr<Courier> courier;
    std::atomic<SteadyTime> beat{steady_now()};
    std::thread thread;
};

NotifyService::NotifyService(const NotifyConfig& config) : config_(config) {
    for (const NotifyRule& rule : config.rules) {
        if (std::ranges::find(areas_, rule.area, &AreaWatch::area) == areas_.end())
            areas_.emplace_back(config.cache, rule.area, config.freezing);
    }
}

Result<std::unique_ptr<NotifyService>> NotifyService::open(FileSystem& file_system,
                                                           const NotifyConfig& config) {
    std::unique_ptr<NotifyService> service(new NotifyService(config));
    for (const NotifyRule& rule : config.rules) {
        if (Status added = service->add(file_system, rule); !added) return pass_on(added);
    }
    for (const auto& post : service->posts_)
        post->thread = std::thread([&of = *service, &own = *post] { of.run(own); });
    return service;
}

Status NotifyService::add(FileSystem& file_system, const NotifyRule& rule) {
    auto outbox = Outbox::open(file_system, config_.directory / rule.name);
    if (!outbox) return pass_on(outbox);
    auto post = std::make_unique<Post>(rule);
    post->outbox = std::move(*outbox);
    auto sender = make_sender(rule, stop_, [&own = *post] { own.beat = steady_now(); });
    if (!sender) return pass_on(sender);
    post->courier = std::make_unique<Courier>(rule.name, *post->outbox, std::move(*sender));
    posts_.push_back(std::move(post));
    return {};
}

NotifyService::~NotifyService() {
    {
        const MutexLock lock(mutex_);
        stop_ = true;
    }
    stopped_.notify_all();
    for (const auto& post : posts_) {
        if (post->thread.joinable()) post->thread.join();
    }
}

void NotifyService::run(Post& post) {
    while (!stop_) {
        post.beat = steady_now();
        bool has_worked = false;
        try {
            has_worked = post.courier->step(now_utc(), steady_now());
        } catch (const std::exception& error) {  // memory is short
            say(LogLevel::error, "{}: cannot deliver: {}", post.rule.name, error.what());
        }
        if (!has_worked) wait();
    }
}

void NotifyService::wait() {
    const MutexLock lock(mutex_);
    if (!stop_) stopped_.wait_until(mutex_, steady_now() + between_steps);
}

Status NotifyService::turn(UtcTime now) {
    Status outcome;
    const SteadyTime end = steady_now() + longest_turn;
    for (std::size_t i = 0; i < areas_.size() && steady_now() < end; ++i) {
        AreaWatch& area = areas_[next_area_];
        next_area_ = (next_area_ + 1) % areas_.size();
        if (Status looked = look_at(area, now); !looked) outcome = std::move(looked);
    }
    for (const auto& post : posts_)
        post->outbox->forget_before(now - post->rule.every - kept_longer);
    return outcome;
}

// Writes the messages of all rules about new cells of an area.
Status NotifyService::look_at(AreaWatch& area, UtcTime now) {
    const auto scan = area.look(now);
    if (!scan) return pass_on(scan);
    if (!*scan) return {};
    Status outcome;
    for (const auto& post : posts_) {
        if (post->rule.area != area.area()) continue;
        if (Status reported = report(*post, **scan); !reported) outcome = std::move(reported);
    }
    if (!outcome) area.report_again();
    return outcome;
}

Status NotifyService::report(Post& post, const retrieve::TrackedScan& scan) {
    const auto last_of = [&](const std::string& cell) { return post.outbox->last_of(cell); };
    for (const Notice& notice : notices_of(post.rule, scan, config_.freezing, last_of)) {
        const auto dropped = post.outbox->put(notice.name, notice.text);
        if (!dropped) return pass_on(dropped);
        say(LogLevel::info, "{}: cell {} of {} at {}", post.rule.name, notice.name.cell, scan.area,
            format_utc(scan.time));
        if (*dropped > 0)
            say(LogLevel::warning, "{}: dropped {}, because more than {} wait", post.rule.name,
                counted(*dropped, "message"), Outbox::most_waiting);
    }
    return {};
}

std::chrono::milliseconds NotifyService::longest_silence() const {
    auto longest = SteadyTime::duration::zero();
    for (const auto& post : posts_)
        longest = std::max(longest, steady_now() - post->beat.load());
    return std::chrono::duration_cast<std::chrono::milliseconds>(longest);
}

}  // namespace stormcellar::notify
