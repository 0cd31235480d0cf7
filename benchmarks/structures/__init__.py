"""Structures of finite elements beside the models of rigid bodies: the restrained wobbling frame
and the rocking podium.
"""
