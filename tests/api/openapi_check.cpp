#include "api/openapi_check.h"

#include <cctype>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "scene/scenario.h"
#include "service/api/openapi_text.h"
#include "service/api/routes.h"

namespace shadowbench::service {
namespace {

using nlohmann::json;

const json& document() {
    static const json value = json::parse(openapi_text());
    return value;
}

// OpenAPI 3.0 -> draft-07: references go to "definitions", "nullable" becomes a type.
json translated(const json& schema) {
    if (schema.is_array()) {
        json out = json::array();
        for (const json& part : schema) out.push_back(translated(part));
        return out;
    }
    if (!schema.is_object()) return schema;
    json out = json::object();
    for (const auto& [key, value] : schema.items()) {
        if (key == "nullable") continue;
        if (key == "$ref") {
            const std::string name = value.get<std::string>();
            out["$ref"] = "#/definitions/" + name.substr(name.rfind('/') + 1);
        } else {
            out[key] = translated(value);
        }
    }
    if (schema.value("nullable", false) && schema.contains("type")) out["type"] = {schema["type"], "null"};
    return out;
}

void check_form(const json& value, const json& schema, const std::string& what) {
    json whole = translated(schema);
    whole["definitions"] = translated(document()["components"]["schemas"]);
    try {
        scene::check_schema(value, whole);
    } catch (const base::Error& error) {
        ADD_FAILURE() << what << ": " << error.what() << "\n" << value.dump().substr(0, 500);
    }
}

}  // namespace

void check_documented(const ApiRequest& request, const ApiResponse& response, const std::string& body) {
    PathParameters parameters;
    std::string allowed;
    const Route* route = find_route(request, parameters, allowed);
    if (!route) {
        EXPECT_EQ(response.type, "application/problem+json");
        check_form(json::parse(body), document()["components"]["schemas"]["Problem"], "a problem");
        return;
    }
    std::string path = route->pattern;
    if (const std::size_t dots = path.find("..."); dots != std::string::npos) path.erase(dots, 3);
    std::string method = route->method;
    for (char& c : method) c = static_cast<char>(std::tolower(c));
    const json& responses = document()["paths"].at(path).at(method)["responses"];
    const std::string status = std::to_string(response.status), what = method + " " + path + " " + status;
    ASSERT_TRUE(responses.contains(status)) << what << " is not documented: " << body.substr(0, 300);
    const json& described = responses[status];
    if (response.type.empty()) {
        EXPECT_FALSE(described.contains("content")) << what;
        return;
    }
    ASSERT_TRUE(described.contains("content")) << what;
    const std::string type = response.type.substr(0, response.type.find(';'));
    const json& content = described["content"];
    ASSERT_TRUE(content.contains(type) || content.contains("*/*")) << what << " gives " << type;
    if (type.find("json") != std::string::npos && content.contains(type) && response.status != 206)
        check_form(json::parse(body), content[type]["schema"], what);
}

}  // namespace shadowbench::service
