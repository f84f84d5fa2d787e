// Converts the barrier's values (barrier/protocol.hpp) to and from their wire forms (idl/constrictor/barrier.idl).
#pragma once

#include <optional>
#include <string>

#include "barrier/protocol.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/endpoint.hpp"

namespace constrictor {

/// The message points to the bytes in `block`, which must outlive it. Throws std::logic_error if the member reads or
/// writes more topics than the message has room for.
msg::TickDone to_wire(const TickDone& done, std::string& block);
/// `message` must have passed validate(). Returns nothing if the checkpoint is damaged. The result uses the memory of
/// `memory`, whose content is lost.
std::optional<TickDone> from_wire(const msg::TickDone& message, TickDone memory = {});
/// The proof of a Hello that is sent by this participant: HMAC-SHA-256, keyed with the token, of the lines "hello", run
/// id, component, incarnation, and participant (24 hexadecimal digits), joined by line feeds. A proof that was read
/// from the network is worth nothing to another participant.
std::string hello_proof(const std::string& token, const Hello& hello, const dds::GuidPrefix& participant);
msg::Hello to_wire(const Hello& hello);
Hello from_wire(const msg::Hello& message);
msg::Resume to_wire(const Resume& resume, std::string& block);
/// The same for a Resume.
std::optional<Resume> from_wire(const msg::Resume& message);

}  // namespace constrictor
