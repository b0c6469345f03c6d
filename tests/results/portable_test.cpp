#include "results/portable.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace shadowbench::results {
namespace {

TEST(Portable, AsksAtProbesInsteadOfACamera) {
    nlohmann::json camera = {{"receivers", {{"type", "camera"}, {"bias", 0.1}}}, {"timing", {{"repetitions", 9}}}};
    make_portable_document(camera);
    EXPECT_EQ(camera.at("receivers").at("type"), "probes");
    EXPECT_EQ(camera.at("timing").at("repetitions"), 1);
    const nlohmann::json points = {{"type", "points"}, {"points", {{0, 0, 0}}}};
    nlohmann::json given = {{"receivers", points}};
    make_portable_document(given);
    EXPECT_EQ(given.at("receivers"), points);
    nlohmann::json none = nlohmann::json::object();
    make_portable_document(none);
    EXPECT_FALSE(none.contains("receivers")) << "probes are the default";
}

TEST(Portable, DropsAllThatDependsOnTheMachineTheClockOrEmbree) {
    auto result = nlohmann::ordered_json::parse(R"({
        "program": {"version": "1", "commit": "c", "compiler": "g", "build_type": "Release"},
        "machine": {"cpu": "EPYC", "logical_cores": 2},
        "times": {"started": "2026", "seconds": 3},
        "variants": [{"lights": [{"capture": {"embree_check": {"rays": 7}}, "cells": [
            {"technique": "deep", "status": "ok", "curve_error": {"max": 0.1}, "bytes": 5, "on_bytes_error_front": true,
             "nodes": {"total": 3, "histogram": [1, 2]}, "times": {"build_ms": 1}},
            {"technique": "ray_traced", "status": "ok", "curve_error": null, "nodes": {"histogram": []}, "times": null},
            {"technique": "avsm", "status": "failed", "curve_error": null, "nodes": {"histogram": []}, "times": null}
        ]}]}]})");
    make_portable_result(result);
    EXPECT_EQ(nlohmann::json::parse(result.dump()), nlohmann::json::parse(R"({
        "program": {"version": "1", "commit": "any", "compiler": "any", "build_type": "any"},
        "machine": {"cpu": "any", "logical_cores": 0},
        "times": {"started": ""},
        "variants": [{"lights": [{"cells": [
            {"technique": "deep", "status": "ok", "curve_error": {"max": 0.1}, "bytes": 5, "nodes": {"total": 3},
             "times": null},
            {"technique": "avsm", "status": "failed", "curve_error": null, "nodes": {}, "times": null}
        ]}]}]})"))
        << "a failed technique stays, whatever it stores";
}

}  // namespace
}  // namespace shadowbench::results
