// tests/level2/foreign/odim_files.h -- small files of ODIM_H5.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/level2/foreign/hdf5_writer.h"

namespace stormcellar::testing {

// Begins a file of the radar of Kiruna.
inline void begin_odim(Hdf5Writer& file, const std::string& object = "PVOL",
                       const std::string& version = "V2_2") {
    file.text("Conventions", "ODIM_H5/" + version);
    file.group("what")
        .text("object", object)
        .varying_text("version", "H5rad 2.2")
        .text("date", "20240102")
        .text("time", "030400")
        .varying_text("source", "NOD:sekrn,WMO:02032,PLC:Kiruna");
    file.group("where").number("lat", 67.8).number("lon", 20.25F).number("height", 646);
}

struct OdimSweep {
    int number = 1;
    double elevation_deg = 0.5;
    double rscale_m = 500;
    double rstart = 0;
};

// Begins a data set of a sweep that took from 03:04:05 to 03:04:17.
inline std::string begin_dataset(Hdf5Writer& file, const OdimSweep& sweep = {}) {
    const std::string name = "dataset" + std::to_string(sweep.number);
    file.group(name + "/what")
        .text("product", "SCAN")
        .text("startdate", "20240102")
        .text("starttime", "030405")
        .text("enddate", "20240102")
        .text("endtime", "030417");
    file.group(name + "/where")
        .number("elangle", sweep.elevation_deg)
        .number("rscale", sweep.rscale_m)
        .number("rstart", sweep.rstart)
        .number("a1gate", std::int64_t{0});
    return name;
}

template <class Number>
void add_quantity(Hdf5Writer& file, const std::string& dataset, int number,
                  const std::string& quantity, std::size_t rays, const std::vector<Number>& values,
                  double nodata = 255, double undetect = 0, std::size_t chunk_rows = 0) {
    const std::string group = dataset + "/data" + std::to_string(number);
    file.group(group + "/what")
        .text("quantity", quantity)
        .number("gain", 0.5)
        .number("offset", -32.0F)
        .number("nodata", nodata)
        .number("undetect", undetect);
    file.group(group).data("data", rays, values, chunk_rows);
}

}  // namespace stormcellar::testing
