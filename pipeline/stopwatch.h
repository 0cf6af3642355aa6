// pipeline/stopwatch.h -- how long something took.
//
// Inside the pipeline room only. Thread contract: a function without state.
#pragma once

#include <chrono>

namespace stormcellar::pipeline {

[[nodiscard]] inline double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace stormcellar::pipeline
