#include "rest_replies.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include <spindrift/service/rest_api.h>
#include <spindrift/v1/api.pb.h>
#include <spindrift/wire/api_message.h>

namespace spindrift::service {

using core::ErrorCode;
using net::HttpReply;

HttpReply json(unsigned status, const google::protobuf::Message& message) {
  return {.status = status, .content_type = "application/json", .body = wire::toJson(message) + "\n"};
}

HttpReply problem(unsigned status, std::string line) {
  v1::Problem out;
  out.set_message(std::move(line));
  return json(status, out);
}

HttpReply wrongMethod(const std::string& allowed) {
  HttpReply out = problem(405, "the method is not allowed here: use " + allowed);
  out.headers.emplace_back("Allow", allowed);
  return out;
}

HttpReply unauthorized(std::string line) {
  HttpReply out = problem(401, std::move(line));
  out.headers.emplace_back("WWW-Authenticate", "Bearer");
  return out;
}

HttpReply bodyIsNotEmpty() {
  return problem(400, "this request has an empty body: send Content-Length: 0");
}

HttpReply bodyIsNotJson() {
  return problem(415, "send Content-Type: application/json");
}

HttpReply rejected(const wire::CommandRejection& rejection) {
  v1::CommandAnswer out;
  *out.mutable_reject() = rejection;
  return json(httpStatusOf(rejection.reason()), out);
}

HttpReply text(unsigned status, std::string body) {
  return {.status = status, .content_type = "text/plain; charset=utf-8", .body = std::move(body)};
}

unsigned statusOf(const core::Error& error) {
  return error.code == ErrorCode::kUnavailable ? 503 : error.code == ErrorCode::kInvalidInput ? 409 : 500;
}

std::string_view bodyOf(const net::HttpRequest& request) {
  return {reinterpret_cast<const char*>(request.body.data()), request.body.size()};
}

bool isJson(std::string_view content_type) {
  std::string name(content_type.substr(0, content_type.find(';')));
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
  name.erase(name.find_last_not_of(" \t") + 1);
  return name == "application/json";
}

}  // namespace spindrift::service
