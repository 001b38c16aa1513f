# cmake -DPROGRAM=FILE -DOUT=FOLDER -P helpfiles.cmake: the manual pages and the completions of three shells, below FOLDER, and
# FOLDER/help-files when all are there.
cmake_minimum_required(VERSION 3.25)

# save(FILE ARGUMENT...): what `alpenglow help ARGUMENT...` prints.
function(save file)
  get_filename_component(folder ${OUT}/${file} DIRECTORY)
  file(MAKE_DIRECTORY ${folder})
  execute_process(COMMAND ${PROGRAM} help ${ARGN} OUTPUT_FILE ${OUT}/${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${OUT}/man)
execute_process(COMMAND ${PROGRAM} help --commands OUTPUT_VARIABLE commands COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[a-z]+" commands "${commands}")
foreach(command ${commands})
  save(man/man1/alpenglow-${command}.1 --man ${command})
endforeach()
save(man/man1/alpenglow.1 --man)
save(bash-completion/completions/alpenglow --completion bash)
save(zsh/site-functions/_alpenglow --completion zsh)
save(fish/vendor_completions.d/alpenglow.fish --completion fish)
file(TOUCH ${OUT}/help-files)
