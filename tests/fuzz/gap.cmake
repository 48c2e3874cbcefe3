foreach(fuzzer assignment_fuzz challenge_fuzz comparison_fuzz motion_capture_fuzz own_effects_fuzz playback_path_fuzz reported_places_fuzz)
  kenaf_fuzzer(${fuzzer} SOURCE ${CMAKE_CURRENT_LIST_DIR}/${fuzzer}.cpp LIBRARIES kenaf_gap_commands)
endforeach()
