#include <atomic>
#include <functional>
#include <new>
#include <system_error>
#include <thread>

#include "bunzip/bunzip.h"

namespace stormcellar::bunzip {

void decompress_all(std::span<Job> jobs, std::size_t limit, std::span<Workspace> workspaces,
                    Path path) {
    if (workspaces.empty()) {
        Workspace only;
        return decompress_all(jobs, limit, {&only, 1}, path);
    }
    std::atomic<std::size_t> next = 0;
    std::atomic<bool> out_of_memory = false;
    const auto work = [&](Workspace& workspace) {
        try {
            for (std::size_t i = next++; i < jobs.size(); i = next++)
                jobs[i].outcome =
                    decompress(jobs[i].stream, jobs[i].output, limit, workspace, path);
        } catch (const std::bad_alloc&) {
            out_of_memory = true;
        }
    };
    std::vector<std::thread> threads;
    try {
        for (std::size_t i = 1; i < workspaces.size() && i < jobs.size(); ++i)
            threads.emplace_back(work, std::ref(workspaces[i]));
    } catch (const std::system_error&) {
        // The system has no more threads, so the existing threads do the work.
    } catch (const std::bad_alloc&) {
        // There is no memory for more threads, so the existing threads do the work.
    }
    work(workspaces.front());
    for (std::thread& thread : threads)
        thread.join();
    if (out_of_memory) throw std::bad_alloc{};
}

}  // namespace stormcellar::bunzip
