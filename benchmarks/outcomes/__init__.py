"""A hundred thousand outcomes in one table (`fecolumn.outcomes`): who slides, rocks and falls, by
geometry, friction, stiffness and intensity measures.

motions   the ground motions and their intensity measures
draws     what is drawn: bodies, motions and their amplitudes
models    analyses by the models of rigid bodies, in parts
bodies    analyses of rigid and elastic bodies with contact and friction, as a study
table     the table of all
"""
