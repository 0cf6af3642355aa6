#include "notify/courier.h"

#include "base/counted.h"
#include "fetch/pull/source_puller.h"

namespace stormcellar::notify {

bool Courier::step(UtcTime now, SteadyTime steady) {
    drop_old(now);
    const auto name = outbox_.oldest();
    if (!name || steady < next_try_) return false;
    const auto text = outbox_.read(*name);
    if (!text) {
        say(LogLevel::error, "{}: dropped a message that cannot be read: {}", rule_,
            text.error().message);
        settle(*name);
        return true;
    }
    const Status done = send_(*text);
    note_outcome(*name, done, steady);
    return done || !may_pass(done.error());
}

void Courier::drop_old(UtcTime now) {
    std::size_t dropped = 0;
    for (auto name = outbox_.oldest(); name && name->time < now - longest_age;
         name = outbox_.oldest()) {
        settle(*name);
        ++dropped;
    }
    if (dropped > 0)
        say(LogLevel::warning, "{}: dropped {} of grids older than {} minutes", rule_,
            counted(dropped, "message"), longest_age.count());
}

void Courier::settle(const MessageName& name) {
    settled_.note(outbox_.settle(name));
}

void Courier::note_outcome(const MessageName& name, const Status& done, SteadyTime steady) {
    if (!done && may_pass(done.error())) {
        if (failures_++ == 0)
            say(LogLevel::warning, "{}: will be tried again: {}", rule_, done.error().message);
        next_try_ = steady + pull::pause_after(failures_);
        return;
    }
    if (!done) {
        say(LogLevel::error, "{}: dropped a message: {}", rule_, done.error().message);
    } else {
        say(failures_ > 0 ? LogLevel::info : LogLevel::debug, "{}: delivered {}", rule_, name.id());
    }
    failures_ = 0;
    next_try_ = {};
    settle(name);
}

}  // namespace stormcellar::notify
