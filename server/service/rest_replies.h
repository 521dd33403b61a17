// Replies of the REST interface, and what a request's body has to be.
#pragma once

#include <string>
#include <string_view>

#include <google/protobuf/message.h>

#include <spindrift/core/result.h>
#include <spindrift/net/server.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::service {

net::HttpReply json(unsigned status, const google::protobuf::Message& message);

/// Returns a reply with one line of text for people.
net::HttpReply problem(unsigned status, std::string line);

/// RFC 9110 section 15.5.6: Allow lists the supported methods.
net::HttpReply wrongMethod(const std::string& allowed);

/// RFC 9110 section 15.5.2: WWW-Authenticate names the scheme.
net::HttpReply unauthorized(std::string line);

net::HttpReply bodyIsNotEmpty();
net::HttpReply bodyIsNotJson();

/// Returns the reply for a command that was refused.
net::HttpReply rejected(const wire::CommandRejection& rejection);

net::HttpReply text(unsigned status, std::string body);

/// Returns the HTTP status for an error of the rooms.
unsigned statusOf(const core::Error& error);

/// Views the body; it must outlive the view.
std::string_view bodyOf(const net::HttpRequest& request);

/// RFC 9110 section 8.3.1: media type names are not case-sensitive, and parameters may follow.
bool isJson(std::string_view content_type);

}  // namespace spindrift::service
