// Readers of the messages that are more than a row of fields. Each takes the reader of what stands behind the two
// letters, and complains there about what it cannot read.
#pragma once

#include "protocol/messages.hpp"
#include "protocol/parameter_reader.hpp"

namespace linefeed::protocol {

/// In standby nothing but the machine state is valid (section 4, RS).
[[nodiscard]] MachineStatus read_machine_status(ParameterReader& in);
[[nodiscard]] JobCounters read_job_counters(ParameterReader& in);
[[nodiscard]] CounterReset read_counter_reset(ParameterReader& in);
[[nodiscard]] ErrorListBlock read_error_list(ParameterReader& in);
[[nodiscard]] EventListBlock read_event_list(ParameterReader& in);
[[nodiscard]] WysiwygLine read_wysiwyg_line(ParameterReader& in);
[[nodiscard]] ExternText read_extern_text(ParameterReader& in, EscapeMode escapes);
[[nodiscard]] DirectoryBlock read_directory_block(ParameterReader& in, EscapeMode escapes);
[[nodiscard]] FileBlock read_file_block(ParameterReader& in);

} // namespace linefeed::protocol
