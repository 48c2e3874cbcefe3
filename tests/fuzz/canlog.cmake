kenaf_fuzzer(canlog_fuzz SOURCE canlog_fuzz.cpp LIBRARIES kenaf_canlog kenaf_candrives)
