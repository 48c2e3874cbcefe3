kenaf_fuzzer(session_fuzz SOURCE session_fuzz.cpp LIBRARIES kenaf_world_server spdlog::spdlog fmt::fmt)
