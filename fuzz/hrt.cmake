kenaf_fuzzer(config_fuzz SOURCE config_fuzz.cpp LIBRARIES kenaf_hrt_config)
