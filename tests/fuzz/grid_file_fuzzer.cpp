#include "tests/fuzz/libfuzzer.h"
#include "tests/fuzz/properties.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    stormcellar::fuzz::check_grid_file({reinterpret_cast<const std::byte*>(data), size});
    return 0;
}

std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                    unsigned seed) {
    return stormcellar::fuzz::mutate_in_place(stormcellar::fuzz::mutate_grid_file, data, size, most,
                                              seed);
}
