// The forms that the values of options have. A value of another form is refused at the start, with what was meant where
// that can be told: later it would only never match, or fail in the middle of the work.
#pragma once

#include <cstdint>

#include <CLI/CLI.hpp>

namespace spindrift::cli {

/// A finite number between the bounds, which are part of the help.
CLI::Validator numberIn(double min, double max);
/// The same without a fraction.
CLI::Validator integerIn(std::int64_t min, std::int64_t max);

/// Not empty: an empty name would count as an option that was left out.
CLI::Validator isNotEmpty();
/// Not empty, without blanks at its ends and control characters: a text that is compared with others.
CLI::Validator isText();
/// An address to listen on: net::checkListenAddress().
CLI::Validator isListenAddress();
/// A network of a proxy: net::checkNetwork(). Removes blanks at its ends; use with transform().
CLI::Validator isNetwork();
/// Accepts an Origin as browsers send it, or "*" for any: net::checkOrigin(). Removes blanks at its ends; use with
/// transform().
CLI::Validator isOrigin();
/// The same for the Origin of a page that embeds the water: net::checkParentOrigin().
CLI::Validator isParentOrigin();
/// ws://HOST[:PORT][/PATH] or wss://HOST[:PORT][/PATH].
CLI::Validator isUrl();
/// The same without a path.
CLI::Validator isServer();
/// http://HOST[:PORT][/PATH] or https://HOST[:PORT][/PATH], without query and fragment.
CLI::Validator isPageUrl();
/// One or several nats:// or tls:// URLs with ',' between them. What is wrong is said without their passwords.
CLI::Validator isNatsServers();
/// NAME=SCENE.
CLI::Validator isRoom();
/// A file that can be written when the work is done: in a folder that exists. "-" is standard output.
CLI::Validator isOutputFile();

}  // namespace spindrift::cli
