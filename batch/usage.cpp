#include "batch/usage.h"

#include <sys/resource.h>

#include "base/host_name.h"

namespace stormcellar::batch {
namespace {

rusage usage_now() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return usage;
}

double seconds_of(const timeval& time) {
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) / 1e6;
}

double cpu_seconds(const rusage& usage) {
    return seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
}

}  // namespace

Usage::Usage() : started_(now_utc()), cpu_s_(cpu_seconds(usage_now())) {}

void Usage::end(Record& record) const {
    const rusage usage = usage_now();
    record.started = started_;
    record.ended = now_utc();
    record.cpu_s = cpu_seconds(usage) - cpu_s_;
    record.memory_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
    record.host = host_name();
}

}  // namespace stormcellar::batch
