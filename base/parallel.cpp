#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

namespace stormcellar {

void for_each_piece(int count, int threads, const std::function<void(int)>& work) {
    std::atomic<int> next{0};
    std::atomic<bool> has_failed{false};
    std::exception_ptr failure;
    const auto run = [&] {
        try {
            for (int i = next.fetch_add(1); i < count && !has_failed; i = next.fetch_add(1))
                work(i);
        } catch (...) {
            if (!has_failed.exchange(true)) failure = std::current_exception();
        }
    };
    {
        std::vector<std::jthread> others;
        try {
            for (int i = 1; i < std::min(threads, count); ++i)
                others.emplace_back(run);
        } catch (const std::system_error&) {
            // The system has no more threads, so the existing threads do the work.
        } catch (const std::bad_alloc&) {
            // The existing threads do the work in this case, too.
        }
        run();
    }
    if (failure) std::rethrow_exception(failure);
}

}  // namespace stormcellar
