" Scenes of wrt in the native language.  What stands between @begin and @end comes from the tables of
" the program (tests/editors.sh --update).
if exists("b:current_syntax")
  finish
endif
syntax case match

" @begin keywords
syntax keyword wrtKeyword wrt model let param material texture include fn default define assert for in if else
" @end
" @begin kinds
syntax keyword wrtKind area camera cylinder emissive glass group image lambert light mesh metal phong point quad settings shiny sphere sun triangle
" @end
" @begin functions
syntax match wrtFunction /\v<(abs|sign|floor|ceil|round|sqrt|exp|log|sin|cos|tan|asin|acos|atan2|min|max|clamp|lerp|smoothstep|dot|cross|length|normalize|distance|rotate|rgb|hsv|range|steps|len|str|rand)>\ze\s*\(/
" @end
" @begin words
syntax keyword wrtWord classic inverse_square linear modern nearest none orthographic perspective srgb
" @end
syntax keyword wrtConstant pi
syntax keyword wrtBoolean true false

" @begin properties
syntax match wrtProperty /\v<(ambient|back|background|base|center|compat|depth|diffuse|direction|encoding|exponent|eye|falloff|file|filter|flip_normals|fov|height|intensity|ior|lens|look_at|material|matrix|normal_map|object|position|radius|reflection|refraction|resolution|rotate|samples|scale|shape|show_normals|size|smooth|specular|texture|top|translate|up|uv_file|uv_offset|uv_scale|uvs|vertices|yfov)>\ze\s*:/
" @end

syntax match wrtNumber /\v<\d+(\.\d*)?([eE][+-]?\d+)?(deg|rad)?>/
syntax match wrtNumber /\v\.\d+([eE][+-]?\d+)?(deg|rad)?>/
syntax match wrtColour /#\x\{6}\>/
syntax match wrtEscape /\\\%(["\\nt]\|u{\x\+}\)/ contained
syntax region wrtString start=/"/ skip=/\\./ end=/"/ end=/$/ contains=wrtEscape,@Spell
syntax match wrtAllow /wrt: allow([^)]*)/ contained
syntax match wrtComment +//.*$+ contains=wrtAllow,@Spell
syntax region wrtComment start=+/\*+ end=+\*/+ contains=wrtAllow,@Spell
syntax sync ccomment wrtComment

highlight default link wrtKeyword Statement
highlight default link wrtKind Type
highlight default link wrtFunction Function
highlight default link wrtWord Constant
highlight default link wrtConstant Constant
highlight default link wrtBoolean Boolean
highlight default link wrtProperty Identifier
highlight default link wrtNumber Number
highlight default link wrtColour Number
highlight default link wrtString String
highlight default link wrtEscape SpecialChar
highlight default link wrtComment Comment
highlight default link wrtAllow PreProc

let b:current_syntax = "wrt"
