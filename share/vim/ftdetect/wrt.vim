" Scenes of wrt in the native language.
autocmd BufNewFile,BufRead *.wrt setfiletype wrt
