(** What every theorem of Main.v says and rests on; this output is kept in Assumptions.golden. *)

From Coq Require Import Reals.
From Kickdrift Require Import Vocabulary Algebra Stability Floquet TanCriterion Respa ImplicitExplicit Proposition Plane Cone Returns.
From Kickdrift Require Main.
Open Scope R_scope.
Set Printing Width 110.

Check Main.det_propagator. Print Assumptions Main.det_propagator.
Check Main.propagator_rev. Print Assumptions Main.propagator_rev.
Check Main.palindrome. Print Assumptions Main.palindrome.
Check Main.strikes_times. Print Assumptions Main.strikes_times.
Check Main.strikes_times_late. Print Assumptions Main.strikes_times_late.
Check Main.tick_slow. Print Assumptions Main.tick_slow.
Check Main.two_clocks_palindrome. Print Assumptions Main.two_clocks_palindrome.
Check Main.many_clocks_palindrome. Print Assumptions Main.many_clocks_palindrome.
Check Main.swap_clocks. Print Assumptions Main.swap_clocks.
Check Main.strikes_middle. Print Assumptions Main.strikes_middle.
Check Main.scaling. Print Assumptions Main.scaling.
Check Main.staggered_trace. Print Assumptions Main.staggered_trace.
Check Main.staggered_bounded. Print Assumptions Main.staggered_bounded.
Check Main.bounded_iff. Print Assumptions Main.bounded_iff.
Check Main.four_signs. Print Assumptions Main.four_signs.
Check Main.row_total. Print Assumptions Main.row_total.
Check Main.row_unique. Print Assumptions Main.row_unique.
Check Main.symmetric_verdict. Print Assumptions Main.symmetric_verdict.
Check Main.two_clocks_verdict. Print Assumptions Main.two_clocks_verdict.
Check Main.multiplier_plus. Print Assumptions Main.multiplier_plus.
Check Main.multiplier_minus. Print Assumptions Main.multiplier_minus.
Check Main.verlet. Print Assumptions Main.verlet.
Check Main.rotation_power. Print Assumptions Main.rotation_power.
Check Main.sin_angle. Print Assumptions Main.sin_angle.
Check Main.respa_trace. Print Assumptions Main.respa_trace.
Check Main.respa_two_clocks. Print Assumptions Main.respa_two_clocks.
Check Main.respa_tan. Print Assumptions Main.respa_tan.
Check Main.respa_window. Print Assumptions Main.respa_window.
Check Main.implicit_explicit. Print Assumptions Main.implicit_explicit.
Check Main.proposition. Print Assumptions Main.proposition.
Check Main.proposition_forward. Print Assumptions Main.proposition_forward.
Check Main.proposition_backward. Print Assumptions Main.proposition_backward.
Check Main.proposition_gap. Print Assumptions Main.proposition_gap.
Check Main.symmetric_form. Print Assumptions Main.symmetric_form.
Check Main.resonant_steps. Print Assumptions Main.resonant_steps.
Check Main.sign_of_b. Print Assumptions Main.sign_of_b.
Check Main.wronskian. Print Assumptions Main.wronskian.
Check Main.update_kick. Print Assumptions Main.update_kick.
Check Main.foreign_kicks. Print Assumptions Main.foreign_kicks.
Check Main.foreign_ticks. Print Assumptions Main.foreign_ticks.
Check Main.angle. Print Assumptions Main.angle.
Check Main.cosines. Print Assumptions Main.cosines.
Check Main.sines. Print Assumptions Main.sines.
Check Main.trig_update. Print Assumptions Main.trig_update.
Check Main.four_forms. Print Assumptions Main.four_forms.
Check Main.tan_criterion. Print Assumptions Main.tan_criterion.
Check Main.tan_criterion_q1. Print Assumptions Main.tan_criterion_q1.
Check Main.tan_criterion_q2. Print Assumptions Main.tan_criterion_q2.
Check Main.no_closing_q1. Print Assumptions Main.no_closing_q1.
Check Main.no_closing_q2. Print Assumptions Main.no_closing_q2.
Check Main.no_closing_p1. Print Assumptions Main.no_closing_p1.
Check Main.no_closing_p2. Print Assumptions Main.no_closing_p2.
Check Main.perturbed_orbit. Print Assumptions Main.perturbed_orbit.
Check Main.sign_certificate. Print Assumptions Main.sign_certificate.
Check Main.sign_certificate_rounded. Print Assumptions Main.sign_certificate_rounded.
Check Main.perturbed_orbit_stepwise. Print Assumptions Main.perturbed_orbit_stepwise.
Check Main.shear_turn. Print Assumptions Main.shear_turn.
Check Main.update_contained. Print Assumptions Main.update_contained.
Check Main.contained_inverse. Print Assumptions Main.contained_inverse.
Check Main.shrink_bound. Print Assumptions Main.shrink_bound.
Check Main.cone_chain. Print Assumptions Main.cone_chain.
Check Main.cone_criterion. Print Assumptions Main.cone_criterion.
Check Main.pulled_back. Print Assumptions Main.pulled_back.
Check Main.deep_level. Print Assumptions Main.deep_level.
Check Main.last_period. Print Assumptions Main.last_period.
Check Main.walk_product. Print Assumptions Main.walk_product.
Check Main.band_growth. Print Assumptions Main.band_growth.
Check Main.certificate. Print Assumptions Main.certificate.
Check Main.certificate_pi. Print Assumptions Main.certificate_pi.
Check Main.edge_between. Print Assumptions Main.edge_between.
