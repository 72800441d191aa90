(** * The a-posteriori error bound of a computed orbit

    An exact orbit u_k = M_k u_(k-1) with det M_k = 1, and a computed one uh_k = M_k uh_(k-1) + r_k
    that starts at the same vector. In the moving frame (uh_k, J uh_k) the exact orbit is

        u_k = a_k (uh_k + (t_k / |uh_k|^2) J uh_k),     |t_k| <= 2 b_k,     b_k >= sum_(j<=k) |r_j| |uh_j|

    so the error along the orbit is a factor a_k > 0 near 1, and the error across it is small however
    long the orbit has become: a sign is certified although the orbit grows.

    - [perturbed_orbit]   the bound;
    - [perturbed_orbit_stepwise]
                          the same with each step's own constants in place of the worst step's;
    - [shear_turn]        what c needs for kicks and drifts;
    - [sign_certificate]  a linear form <v, uh_k> that is large enough has the sign of <v, u_k>;
    - [sign_certificate_rounded]
                          the same when the form itself is only known to within delta;
    - [contained_inverse], [shrink_bound]
                          |M y| <= kappa |y| bounds the inverse too, so g = kappa / (1 - kappa eps) will do;
    - [update_contained]  a Floquet update has kappa = 1 + |k| (E^2 + O^2).                         *)

From Kickdrift Require Import Vocabulary Algebra Floquet Plane.
From Coq Require Import Reals Lra Lia Psatz.
Open Scope R_scope.

(** ** Bernoulli's inequality, both ways *)

Lemma bernoulli x n : 0 <= x <= 1 -> 1 - INR n * x <= (1 - x) ^ n.
Proof.
  intros X; induction n as [|n IH]; [simpl; lra|].
  rewrite S_INR; simpl; pose proof (pos_INR n).
  assert (0 <= (1 - x) ^ n) by (apply pow_le; lra).
  apply Rle_trans with ((1 - x) * (1 - INR n * x)); [|apply Rmult_le_compat_l; lra].
  assert (0 <= INR n * (x * x)) by (apply Rmult_le_pos; nra). nra.
Qed.

Lemma bernoulli_inv x n : 0 <= x <= 1 -> (1 + x) ^ n * (1 - INR n * x) <= 1.
Proof.
  intros X; pose proof (bernoulli x n X) as B.
  assert (P : 0 < (1 + x) ^ n) by (apply pow_lt; lra).
  apply Rle_trans with ((1 + x) ^ n * (1 - x) ^ n); [nra|].
  rewrite <- Rpow_mult_distr; replace ((1 + x) * (1 - x)) with (1 - x * x) by ring.
  apply Rle_trans with (1 ^ n); [apply pow_incr; split; nra | rewrite pow1; lra].
Qed.

(** ** One step *)

Section OneStep.
Variables (M : mat) (uh r : vec) (kappa eps g tau t : R).
Let uh' := add (M @ uh) r.
Hypotheses (D : det M = 1) (K : forall y, len (M @ y) <= kappa * len y).
Hypotheses (N : uh <> zero) (N' : uh' <> zero).
Hypotheses (R : len r <= eps * len uh) (G : len uh <= g * len uh').
Hypotheses (T : Rabs t <= tau * (len uh * len uh)).
Let omega := g * eps + g * kappa * tau.
Hypothesis O : omega < 1.

Let z := M @ J uh.
Let y := M @ add uh (smul (t / (len uh * len uh)) (J uh)).
Let alpha := dot uh' y / (len uh' * len uh').
Let t' := cross uh' y / alpha.

Lemma z_len : len z <= kappa * len uh.
Proof. unfold z; rewrite <- (len_J uh); apply K. Qed.

Lemma y_split : y = add (add uh' (smul (-1) r)) (smul (t / (len uh * len uh)) z).
Proof. unfold y, uh', z; generalize (t / (len uh * len uh)); intros c; apply vec_ext; coordinates; ring. Qed.

Lemma alpha_near : Rabs (alpha - 1) <= omega.
Proof.
  pose proof (len_pos _ N) as P; pose proof (len_pos _ N') as P'; pose proof z_len as Z.
  pose proof R as R0; pose proof G as G0; pose proof T as T0; pose proof (len_nonneg r) as Pr.
  set (l := len uh) in *; set (l' := len uh') in *.
  assert (E : alpha - 1 = - (dot uh' r / (l' * l')) + t / (l * l) * (dot uh' z / (l' * l'))).
  { unfold alpha; rewrite y_split; fold l.
    replace (dot uh' (add (add uh' (smul (-1) r)) (smul (t / (l * l)) z)))
      with (dot uh' uh' - dot uh' r + t / (l * l) * dot uh' z) by (coordinates; ring).
    rewrite <- (len_sqr uh'); fold l'; field; lra. }
  rewrite E; eapply Rle_trans; [apply Rabs_triang|]; rewrite Rabs_Ropp, Rabs_mult.
  unfold omega; apply Rplus_le_compat.
  - unfold Rdiv; rewrite Rabs_mult, (Rabs_pos_eq (/ (l' * l'))) by (apply Rlt_le, Rinv_0_lt_compat; nra).
    apply Rmult_le_reg_r with (l' * l'); [nra|]; rewrite Rmult_assoc, Rinv_l, Rmult_1_r by nra.
    eapply Rle_trans; [apply dot_le|]; fold l'.
    assert (0 <= eps) by nra.
    assert (eps * l <= eps * (g * l')) by (apply Rmult_le_compat_l; assumption). nra.
  - apply Rle_trans with (tau * (kappa * g)); [|nra].
    apply Rmult_le_compat; try apply Rabs_pos.
    + unfold Rdiv; rewrite Rabs_mult, (Rabs_pos_eq (/ (l * l))) by (apply Rlt_le, Rinv_0_lt_compat; nra).
      apply Rmult_le_reg_r with (l * l); [nra|]; rewrite Rmult_assoc, Rinv_l, Rmult_1_r by nra; exact T0.
    + unfold Rdiv; rewrite Rabs_mult, (Rabs_pos_eq (/ (l' * l'))) by (apply Rlt_le, Rinv_0_lt_compat; nra).
      apply Rmult_le_reg_r with (l' * l'); [nra|]; rewrite Rmult_assoc, Rinv_l, Rmult_1_r by nra.
      eapply Rle_trans; [apply dot_le|]; fold l'.
      assert (0 <= kappa) by (pose proof (len_nonneg z); nra).
      assert (kappa * l <= kappa * (g * l')) by (apply Rmult_le_compat_l; lra). nra.
Qed.

Lemma alpha_bounds : 1 - omega <= alpha <= 1 + omega.
Proof.
  pose proof alpha_near as A.
  unfold Rabs in A; destruct Rcase_abs; lra.
Qed.

Lemma step_frame : y = smul alpha (add uh' (smul (t' / (len uh' * len uh')) (J uh'))).
Proof.
  pose proof alpha_bounds as A; pose proof (len_pos _ N') as P'.
  rewrite (frame uh' y N') at 1; fold alpha.
  unfold t'; apply vec_ext; simpl; field; split; nra.
Qed.

(** x bounds what the residual turns: kappa eps will do, a shear that errs along itself turns less. *)
Lemma step_cross_by x : Rabs (cross r z) <= x * (len uh * len uh) ->
  Rabs t' <= (Rabs t * (1 + x) + len uh' * len r) / (1 - omega).
Proof.
  intros X; pose proof alpha_bounds as A; pose proof (len_pos _ N) as P.
  assert (E : cross uh' y = - cross uh' r + t * (1 + cross r z / (len uh * len uh))).
  { assert (W : cross uh' z = len uh * len uh + cross r z).
    { rewrite len_sqr; replace (dot uh uh) with (det M * dot uh uh) by (rewrite D; ring).
      unfold uh', z; coordinates; ring. }
    rewrite y_split.
    replace (cross uh' (add (add uh' (smul (-1) r)) (smul (t / (len uh * len uh)) z)))
      with (- cross uh' r + t / (len uh * len uh) * cross uh' z) by (coordinates; ring).
    rewrite W; field; lra. }
  assert (B : Rabs (cross uh' y) <= Rabs t * (1 + x) + len uh' * len r).
  { rewrite E; eapply Rle_trans; [apply Rabs_triang|]; rewrite Rabs_Ropp, Rabs_mult, Rplus_comm.
    apply Rplus_le_compat; [|apply cross_le].
    apply Rmult_le_compat_l; [apply Rabs_pos|].
    eapply Rle_trans; [apply Rabs_triang|]; rewrite Rabs_R1; apply Rplus_le_compat_l.
    unfold Rdiv; rewrite Rabs_mult, (Rabs_pos_eq (/ (len uh * len uh))) by (apply Rlt_le, Rinv_0_lt_compat; nra).
    apply Rmult_le_reg_r with (len uh * len uh); [nra|]; rewrite Rmult_assoc, Rinv_l, Rmult_1_r by nra; exact X. }
  unfold t', Rdiv; rewrite Rabs_mult, (Rabs_pos_eq (/ alpha)) by (apply Rlt_le, Rinv_0_lt_compat; lra).
  apply Rmult_le_compat; [apply Rabs_pos | apply Rlt_le, Rinv_0_lt_compat; lra | exact B |].
  apply Rinv_le_contravar; lra.
Qed.

Lemma step_cross : Rabs t' <= (Rabs t * (1 + kappa * eps) + len uh' * len r) / (1 - omega).
Proof.
  apply step_cross_by; pose proof (len_pos _ N) as P; pose proof z_len as Z.
  eapply Rle_trans; [apply cross_le|].
  apply Rle_trans with (eps * len uh * (kappa * len uh)); [|right; ring].
  apply Rmult_le_compat; try apply len_nonneg; assumption.
Qed.
End OneStep.

(** ** The orbit *)

Section Orbit.
Variables (M : nat -> mat) (u uh r : nat -> vec) (b : nat -> R) (n : nat) (kappa eps g tau : R).
Let omega := g * eps + g * kappa * tau.

(** The steps: k = 0 ... n - 1 leads from the k-th to the (k+1)-st vector. *)
Hypothesis start : u O = uh O.
Hypothesis exact : forall k, (k < n)%nat -> u (S k) = M k @ u k.
Hypothesis computed : forall k, (k < n)%nat -> uh (S k) = add (M k @ uh k) (r k).
Hypothesis unimodular : forall k, (k < n)%nat -> det (M k) = 1.
Hypothesis contained : forall k y, (k < n)%nat -> len (M k @ y) <= kappa * len y.
Hypothesis nonzero : forall k, (k <= n)%nat -> uh k <> zero.
Hypothesis residual : forall k, (k < n)%nat -> len (r k) <= eps * len (uh k).
Hypothesis shrink : forall k, (k < n)%nat -> len (uh k) <= g * len (uh (S k)).

(** The running bound, and how large it may be beside the orbit (the last vector is exempt). *)
Hypothesis b_start : 0 <= b O.
Hypothesis b_step : forall k, (k < n)%nat -> b k + len (r k) * len (uh (S k)) <= b (S k).
Hypothesis b_small : forall k, (k < n)%nat -> 2 * b k <= tau * (len (uh k) * len (uh k)).

Hypotheses (g_nonneg : 0 <= g) (tau_nonneg : 0 <= tau).
Hypothesis budget : INR n * (kappa * eps + omega) <= 1 / 2.

Lemma signs : (0 < n)%nat -> 0 <= eps /\ 0 <= kappa /\ 0 <= omega /\ 0 <= kappa * eps.
Proof.
  intros P.
  assert (L : 0 < len (uh O)) by (apply len_pos, nonzero; lia).
  assert (E : 0 <= eps) by (pose proof (residual O P); pose proof (len_nonneg (r O)); nra).
  assert (K : 0 <= kappa) by (pose proof (contained O (uh O) P); pose proof (len_nonneg (M O @ uh O)); nra).
  unfold omega; repeat split; try assumption; [|nra].
  assert (0 <= g * kappa) by nra; nra.
Qed.

(** The factor by which the cross error can have been magnified after k steps. *)
Let rho := (1 + kappa * eps) / (1 - omega).

Lemma rho_pow k : (k <= n)%nat -> rho ^ k <= 2.
Proof.
  intros L; destruct (PeanoNat.Nat.eq_dec n 0); [replace k with O by lia; simpl; lra|].
  destruct signs as (E & K & W & KE); [lia|].
  assert (I : INR k <= INR n) by (apply le_INR; lia).
  assert (I1 : 1 <= INR n) by (apply (le_INR 1); lia).
  pose proof (pos_INR k) as Ik.
  set (x := kappa * eps) in *.
  assert (XW : x + omega <= 1 / 2) by nra.
  assert (C : INR k * x + INR k * omega <= 1 / 2) by nra.
  assert (0 <= INR k * x) by nra. assert (0 <= INR k * omega) by nra.
  pose proof (bernoulli_inv x k ltac:(lra)) as B1; pose proof (bernoulli omega k ltac:(lra)) as B2.
  assert (P1 : 0 < (1 - omega) ^ k) by (apply pow_lt; lra).
  assert (P2 : 0 < (1 + x) ^ k) by (apply pow_lt; lra).
  unfold rho, Rdiv; rewrite Rpow_mult_distr, pow_inv.
  apply Rmult_le_reg_r with ((1 - omega) ^ k); [assumption|].
  rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra.
  apply Rle_trans with (2 * (1 - INR k * omega)); [|lra].
  apply Rmult_le_reg_r with (1 - INR k * x); [lra|]. nra.
Qed.

(** The exact orbit in the frame of the computed one. *)
Theorem perturbed_orbit k :
  (k <= n)%nat ->
  exists a t,
    u k = smul a (add (uh k) (smul (t / (len (uh k) * len (uh k))) (J (uh k)))) /\
    Rabs t <= 2 * b k /\
    (1 - omega) ^ k <= a <= (1 + omega) ^ k /\
    0 < a /\ 1 - INR k * omega <= a <= / (1 - INR k * omega).
Proof.
  intros L.
  enough (H : exists a t,
    u k = smul a (add (uh k) (smul (t / (len (uh k) * len (uh k))) (J (uh k)))) /\
    Rabs t <= rho ^ k * b k /\ 0 <= b k /\ (1 - omega) ^ k <= a <= (1 + omega) ^ k).
  { destruct H as (a & t & E & T & B & A); exists a, t.
    assert (T2 : Rabs t <= 2 * b k) by (pose proof (rho_pow k L); nra).
    split; [exact E|]; split; [exact T2|]; split; [exact A|].
    destruct k as [|k]; [simpl in *; rewrite Rmult_0_l, Rminus_0_r, Rinv_1; lra|].
    destruct signs as (_ & _ & W & KE); [lia|].
    assert (I : INR (S k) <= INR n) by (apply le_INR; lia).
    assert (I1 : 1 <= INR (S k)) by (apply (le_INR 1); lia).
    assert (C : INR (S k) * omega <= 1 / 2) by nra.
    assert (O : omega <= 1 / 2) by nra.
    pose proof (bernoulli omega (S k) ltac:(lra)) as B1; pose proof (bernoulli_inv omega (S k) ltac:(lra)) as B2.
    repeat split; [lra..|].
    apply Rle_trans with ((1 + omega) ^ S k); [lra|].
    apply Rmult_le_reg_r with (1 - INR (S k) * omega); [lra|]; rewrite Rinv_l; lra. }
  induction k as [|k IH].
  - exists 1, 0; rewrite start; simpl; rewrite Rabs_R0; repeat split; try lra.
    apply vec_ext; simpl; unfold Rdiv; ring.
  - destruct IH as (a & t & E & T & B & A); [lia|].
    assert (Lk : (k < n)%nat) by lia.
    destruct signs as (Pe & Pk & W & KE); [lia|].
    assert (I1 : 1 <= INR n) by (apply (le_INR 1); lia).
    assert (O : omega <= 1 / 2) by nra.
    assert (T2 : Rabs t <= tau * (len (uh k) * len (uh k))).
    { pose proof (rho_pow k ltac:(lia)); pose proof (b_small k Lk); nra. }
    pose proof (nonzero (S k) ltac:(lia)) as N'; pose proof (shrink k Lk) as G.
    rewrite (computed k Lk) in N', G.
    pose proof (nonzero k ltac:(lia)) as N.
    pose proof (alpha_bounds (M k) (uh k) (r k) kappa eps g tau t (fun y => contained k y Lk) N N'
      (residual k Lk) G T2) as AB.
    pose proof (step_frame (M k) (uh k) (r k) kappa eps g tau t (fun y => contained k y Lk) N N'
      (residual k Lk) G T2 ltac:(fold omega; lra)) as SF.
    pose proof (step_cross (M k) (uh k) (r k) kappa eps g tau t (unimodular k Lk) (fun y => contained k y Lk) N N'
      (residual k Lk) G T2 ltac:(fold omega; lra)) as SC.
    rewrite <- (computed k Lk) in AB, SF, SC; fold omega in AB, SC.
    set (al := dot (uh (S k)) (M k @ add (uh k) (smul (t / (len (uh k) * len (uh k))) (J (uh k)))) /
        (len (uh (S k)) * len (uh (S k)))) in *.
    set (t' := cross (uh (S k)) (M k @ add (uh k) (smul (t / (len (uh k) * len (uh k))) (J (uh k)))) / al) in *.
    exists (al * a), t'; split; [|split; [|split]].
    + rewrite (exact k Lk), E.
      transitivity (smul a (M k @ add (uh k) (smul (t / (len (uh k) * len (uh k))) (J (uh k)))));
        [apply vec_ext; simpl; ring|].
      rewrite SF; apply vec_ext; simpl; ring.
    + eapply Rle_trans; [exact SC|].
      assert (Q : 1 <= (1 + kappa * eps) / (1 - omega)).
      { apply Rmult_le_reg_r with (1 - omega); [lra|]; unfold Rdiv; rewrite Rmult_assoc, Rinv_l by lra; lra. }
      fold rho in Q.
      assert (Qk : 1 <= rho ^ k) by (apply pow_R1_Rle; exact Q).
      pose proof (b_step k Lk) as BS; pose proof (len_nonneg (r k)); pose proof (len_nonneg (uh (S k))).
      assert (X : 0 <= len (r k) * len (uh (S k))) by nra.
      apply Rle_trans with (rho * (Rabs t + len (uh (S k)) * len (r k))).
      { replace (rho * (Rabs t + len (uh (S k)) * len (r k)))
          with ((Rabs t * (1 + kappa * eps) + len (uh (S k)) * len (r k) * (1 + kappa * eps)) / (1 - omega))
          by (unfold rho; field; lra).
        apply Rmult_le_compat_r; [apply Rlt_le, Rinv_0_lt_compat; lra|]; nra. }
      simpl; rewrite Rmult_assoc; apply Rmult_le_compat_l; [lra|].
      apply Rle_trans with (rho ^ k * (b k + len (r k) * len (uh (S k)))); [nra|].
      apply Rmult_le_compat_l; [lra | exact BS].
    + pose proof (b_step k Lk); pose proof (len_nonneg (r k)); pose proof (len_nonneg (uh (S k))).
      assert (0 <= len (r k) * len (uh (S k))) by nra; lra.
    + assert (0 < (1 - omega) ^ k) by (apply pow_lt; lra).
      simpl; split; apply Rmult_le_compat; lra.
Qed.

(** A linear form whose computed value stands clear of the error has the right sign. *)
Theorem sign_certificate k v :
  (k <= n)%nat ->
  2 * b k * len v < Rabs (dot v (uh k)) * len (uh k) ->
  0 < dot v (u k) * dot v (uh k).
Proof.
  intros L S; destruct (perturbed_orbit k L) as (a & t & E & T & _ & A & _).
  pose proof (len_pos _ (nonzero k L)) as P; pose proof (len_nonneg v) as V.
  set (l := len (uh k)) in *; set (d := dot v (uh k)) in *.
  assert (X : dot v (u k) = a * (d + t / (l * l) * dot v (J (uh k)))) by (rewrite E; unfold d; coordinates; ring).
  assert (Y : Rabs (t / (l * l) * dot v (J (uh k))) < Rabs d).
  { pose proof (dot_le v (J (uh k))) as C; rewrite len_J in C; fold l in C.
    rewrite Rabs_mult; unfold Rdiv; rewrite Rabs_mult, (Rabs_pos_eq (/ (l * l)))
      by (apply Rlt_le, Rinv_0_lt_compat; nra).
    apply Rmult_lt_reg_r with (l * l); [nra|].
    replace (Rabs t * / (l * l) * Rabs (dot v (J (uh k))) * (l * l))
      with (Rabs t * Rabs (dot v (J (uh k)))) by (field; lra).
    apply Rle_lt_trans with (2 * b k * (len v * l)).
    - apply Rmult_le_compat; try apply Rabs_pos; assumption.
    - nra. }
  rewrite X; set (e := t / (l * l) * dot v (J (uh k))) in *.
  assert (0 < (d + e) * d) by (unfold Rabs in Y; destruct (Rcase_abs e), (Rcase_abs d); nra).
  nra.
Qed.

(** The form may be rounded too: v is meant, vh is at hand. *)
Theorem sign_certificate_rounded k v vh delta :
  (k <= n)%nat ->
  len (add v (smul (-1) vh)) <= delta ->
  2 * b k * (len vh + delta) + delta * (len (uh k) * len (uh k)) < Rabs (dot vh (uh k)) * len (uh k) ->
  0 < dot v (u k) * dot vh (uh k).
Proof.
  intros L Dl S; pose proof (len_pos _ (nonzero k L)) as P.
  assert (B : 0 <= b k).
  { clear S; induction k as [|k IH]; [exact b_start|].
    pose proof (b_step k ltac:(lia)); pose proof (len_nonneg (r k)); pose proof (len_nonneg (uh (S k))).
    assert (0 <= len (r k) * len (uh (S k))) by nra.
    pose proof (IH ltac:(lia) (len_pos _ (nonzero k ltac:(lia)))); lra. }
  set (e := add v (smul (-1) vh)) in *.
  assert (V : v = add vh e) by (apply vec_ext; unfold e; simpl; ring).
  pose proof (dot_le e (uh k)) as De; pose proof (len_nonneg e).
  assert (De' : Rabs (dot e (uh k)) <= delta * len (uh k)) by nra.
  assert (Sp : dot v (uh k) = dot vh (uh k) + dot e (uh k)) by (rewrite V; coordinates; ring).
  assert (Lv : len v <= len vh + delta).
  { apply Rle_trans with (len vh + len e); [|lra]; rewrite V.
    pose proof (len_nonneg vh); apply Rsqr_incr_0_var; [|lra]; unfold Rsqr.
    rewrite len_sqr; pose proof (dot_le vh e) as C; pose proof (len_sqr vh); pose proof (len_sqr e).
    pose proof (Rle_abs (dot vh e)).
    replace (dot (add vh e) (add vh e)) with (dot vh vh + 2 * dot vh e + dot e e) by (coordinates; ring); nra. }
  assert (Close : 2 * b k * len v < (Rabs (dot vh (uh k)) - delta * len (uh k)) * len (uh k)).
  { apply Rle_lt_trans with (2 * b k * (len vh + delta)); [apply Rmult_le_compat_l; lra | lra]. }
  assert (Bd : 0 <= 2 * b k * len v) by (pose proof (len_nonneg v); nra).
  assert (Big : delta * len (uh k) < Rabs (dot vh (uh k))) by nra.
  assert (Same : 0 < dot v (uh k) * dot vh (uh k) /\ Rabs (dot vh (uh k)) - delta * len (uh k) <= Rabs (dot v (uh k))).
  { rewrite Sp; split; unfold Rabs in *; destruct (Rcase_abs (dot vh (uh k))), (Rcase_abs (dot e (uh k)));
      try destruct Rcase_abs; nra. }
  destruct Same as [Same Far].
  assert (C : 0 < dot v (u k) * dot v (uh k)).
  { apply sign_certificate; [exact L|]; eapply Rlt_le_trans; [exact Close|].
    apply Rmult_le_compat_r; lra. }
  destruct (Rtotal_order (dot v (uh k)) 0) as [X|[X|X]]; nra.
Qed.
End Orbit.

(** ** The orbit, each step with its own constants *)

Section Stepwise.
Variables (M : nat -> mat) (u uh r : nat -> vec) (b w c : nat -> R) (n : nat) (kappa x : nat -> R).
Let tau k := 2 * b k / (len (uh k) * len (uh k)).
Let omega k := (len (r k) + kappa k * tau k * len (uh k)) / len (uh (S k)).

Hypothesis start : u O = uh O.
Hypothesis exact : forall k, (k < n)%nat -> u (S k) = M k @ u k.
Hypothesis computed : forall k, (k < n)%nat -> uh (S k) = add (M k @ uh k) (r k).
Hypothesis unimodular : forall k, (k < n)%nat -> det (M k) = 1.
Hypothesis contained : forall k y, (k < n)%nat -> len (M k @ y) <= kappa k * len y.
Hypothesis nonzero : forall k, (k <= n)%nat -> uh k <> zero.
Hypothesis b_start : 0 <= b O.
Hypothesis b_step : forall k, (k < n)%nat -> b k + len (r k) * len (uh (S k)) <= b (S k).
Hypotheses (w_start : 0 <= w O) (c_start : 0 <= c O).
Hypothesis w_step : forall k, (k < n)%nat -> w k + omega k <= w (S k).
Hypothesis turn : forall k, (k < n)%nat -> Rabs (cross (r k) (M k @ J (uh k))) <= x k * (len (uh k) * len (uh k)).
Hypothesis c_step : forall k, (k < n)%nat -> c k + x k <= c (S k).
Hypothesis budget : w n + c n <= 1 / 2.

Lemma stepwise_b k : (k <= n)%nat -> 0 <= b k.
Proof.
  induction k as [|k IH]; intros L; [exact b_start|].
  pose proof (IH ltac:(lia)); pose proof (b_step k ltac:(lia)).
  pose proof (len_nonneg (r k)); pose proof (len_nonneg (uh (S k))); nra.
Qed.

Lemma stepwise_grow k : (k < n)%nat -> 0 <= kappa k /\ 0 <= tau k /\ 0 <= omega k /\ 0 <= x k.
Proof.
  intros L; pose proof (len_pos _ (nonzero k ltac:(lia))) as P; pose proof (len_pos _ (nonzero (S k) ltac:(lia))) as P'.
  assert (K : 0 <= kappa k).
  { pose proof (contained k (uh k) L); pose proof (len_nonneg (M k @ uh k)); nra. }
  assert (T : 0 <= tau k).
  { pose proof (stepwise_b k ltac:(lia)); unfold tau, Rdiv; apply Rmult_le_pos; [lra|].
    apply Rlt_le, Rinv_0_lt_compat; nra. }
  pose proof (len_nonneg (r k)).
  repeat split; [exact K | exact T | |].
  - unfold omega, Rdiv; apply Rmult_le_pos; [|apply Rlt_le, Rinv_0_lt_compat; exact P'].
    assert (0 <= kappa k * tau k) by (apply Rmult_le_pos; assumption); nra.
  - pose proof (turn k L); pose proof (Rabs_pos (cross (r k) (M k @ J (uh k)))).
    apply Rmult_le_reg_r with (len (uh k) * len (uh k)); nra.
Qed.

Lemma stepwise_budget k : (k <= n)%nat -> 0 <= w k /\ 0 <= c k /\ w k + c k <= 1 / 2.
Proof.
  intros L; assert (N : 0 <= w k /\ 0 <= c k).
  { induction k as [|k IH]; [split; assumption|].
    destruct IH; [lia|]; destruct (stepwise_grow k ltac:(lia)) as (_ & _ & O & X).
    pose proof (w_step k ltac:(lia)); pose proof (c_step k ltac:(lia)); lra. }
  assert (U : forall j, (k + j <= n)%nat -> w k + c k <= w (k + j)%nat + c (k + j)%nat).
  { induction j as [|j IH]; intros Lj; [rewrite PeanoNat.Nat.add_0_r; lra|].
    rewrite PeanoNat.Nat.add_succ_r.
    destruct (stepwise_grow (k + j) ltac:(lia)) as (_ & _ & O & X); pose proof (IH ltac:(lia)).
    pose proof (w_step (k + j) ltac:(lia)); pose proof (c_step (k + j) ltac:(lia)); lra. }
  pose proof (U (n - k)%nat ltac:(lia)) as V; replace (k + (n - k))%nat with n in V by lia.
  destruct N; repeat split; lra.
Qed.

(** One step of the error across: E is what is spent so far of the budget. *)
Lemma stepwise_cross t' t b0 b1 rl E E' om y : 0 <= om -> 0 <= y -> 0 <= E -> E + om + y <= E' -> E' <= 1 / 2 ->
  0 <= t -> 0 <= rl -> t * (1 - E) <= b0 -> b0 + rl <= b1 -> t' <= (t * (1 + y) + rl) / (1 - om) ->
  t' * (1 - E') <= b1.
Proof.
  intros O Y E0 S L T RL B B1 H; set (s := (t * (1 + y) + rl) / (1 - om)) in *.
  assert (Q : s * (1 - om) = t * (1 + y) + rl) by (unfold s; field; lra).
  assert (P : 0 <= s) by (unfold s, Rdiv; apply Rmult_le_pos; [nra | apply Rlt_le, Rinv_0_lt_compat; lra]).
  assert (F : (1 + y) * (1 - E') <= (1 - E) * (1 - om)).
  { apply Rle_trans with ((1 + y) * (1 - E - om - y)); [apply Rmult_le_compat_l; lra|].
    assert (0 <= E * om) by (apply Rmult_le_pos; lra); assert (0 <= y * E) by (apply Rmult_le_pos; lra).
    assert (0 <= y * y) by (apply Rmult_le_pos; lra); assert (0 <= y * om) by (apply Rmult_le_pos; lra); nra. }
  apply Rle_trans with (s * (1 - E')); [apply Rmult_le_compat_r; lra|].
  apply Rmult_le_reg_l with (1 + y); [lra|].
  apply Rle_trans with (s * ((1 - E) * (1 - om))).
  { replace ((1 + y) * (s * (1 - E'))) with (s * ((1 + y) * (1 - E'))) by ring.
    apply Rmult_le_compat_l; [exact P | exact F]. }
  replace (s * ((1 - E) * (1 - om))) with ((1 - E) * (s * (1 - om))) by ring; rewrite Q.
  replace ((1 - E) * (t * (1 + y) + rl)) with (t * (1 - E) * (1 + y) + (1 - E) * rl) by ring.
  assert (t * (1 - E) * (1 + y) <= b0 * (1 + y)) by (apply Rmult_le_compat_r; lra).
  assert ((1 - E) * rl <= rl * (1 + y)) by nra.
  apply Rle_trans with ((b0 + rl) * (1 + y)); [lra|].
  rewrite Rmult_comm; apply Rmult_le_compat_l; lra.
Qed.

(** The exact orbit in the frame of the computed one. *)
Theorem perturbed_orbit_stepwise k :
  (k <= n)%nat ->
  exists a t,
    u k = smul a (add (uh k) (smul (t / (len (uh k) * len (uh k))) (J (uh k)))) /\
    Rabs t <= 2 * b k /\
    0 < a /\ 1 - w k <= a <= / (1 - w k).
Proof.
  intros L.
  enough (H : exists a t,
    u k = smul a (add (uh k) (smul (t / (len (uh k) * len (uh k))) (J (uh k)))) /\
    Rabs t * (1 - (w k + c k)) <= b k /\ 1 - w k <= a /\ a * (1 - w k) <= 1).
  { destruct H as (a & t & E & T & A1 & A2); exists a, t.
    destruct (stepwise_budget k L) as (W & C & B); pose proof (Rabs_pos t).
    split; [exact E|]; repeat split; [nra | lra | lra |].
    apply Rmult_le_reg_r with (1 - w k); [lra|]; rewrite Rinv_l; lra. }
  induction k as [|k IH].
  - destruct (stepwise_budget O L) as (W & C & B).
    exists 1, 0; rewrite start, Rabs_R0; repeat split; try nra.
    apply vec_ext; simpl; unfold Rdiv; ring.
  - destruct IH as (a & t & E & T & A1 & A2); [lia|].
    assert (Lk : (k < n)%nat) by lia.
    destruct (stepwise_grow k Lk) as (K & Tau & O & X).
    destruct (stepwise_budget k ltac:(lia)) as (W & C & B); destruct (stepwise_budget (S k) L) as (W' & C' & B').
    pose proof (w_step k Lk) as WS; pose proof (c_step k Lk) as CS; pose proof (b_step k Lk) as BS.
    pose proof (nonzero k ltac:(lia)) as N; pose proof (nonzero (S k) L) as N'.
    pose proof (len_pos _ N) as P; pose proof (len_pos _ N') as P'.
    pose proof (len_nonneg (r k)) as R; pose proof (Rabs_pos t) as Pt.
    assert (T2 : Rabs t <= tau k * (len (uh k) * len (uh k))).
    { unfold tau, Rdiv; rewrite Rmult_assoc, Rinv_l, Rmult_1_r by nra; nra. }
    assert (Re : len (r k) <= len (r k) / len (uh k) * len (uh k)) by (right; field; lra).
    assert (G : len (uh k) <= len (uh k) / len (uh (S k)) * len (uh (S k))) by (right; field; lra).
    assert (Om : len (uh k) / len (uh (S k)) * (len (r k) / len (uh k))
      + len (uh k) / len (uh (S k)) * kappa k * tau k = omega k) by (unfold omega; field; lra).
    assert (O1 : omega k < 1) by lra.
    rewrite (computed k Lk) in N', G.
    pose proof (alpha_bounds (M k) (uh k) (r k) (kappa k) (len (r k) / len (uh k)) _ (tau k) t
      (fun y => contained k y Lk) N N' Re G T2) as AB.
    pose proof (fun O => step_frame (M k) (uh k) (r k) (kappa k) (len (r k) / len (uh k)) _ (tau k) t
      (fun y => contained k y Lk) N N' Re G T2 O) as SF.
    pose proof (fun O => step_cross_by (M k) (uh k) (r k) (kappa k) (len (r k) / len (uh k)) _ (tau k) t
      (unimodular k Lk) (fun y => contained k y Lk) N N' Re G T2 O (x k) (turn k Lk)) as SC.
    rewrite <- (computed k Lk) in AB, SF, SC; rewrite Om in AB, SF, SC.
    specialize (SF O1); specialize (SC O1).
    set (al := dot (uh (S k)) (M k @ add (uh k) (smul (t / (len (uh k) * len (uh k))) (J (uh k)))) /
        (len (uh (S k)) * len (uh (S k)))) in *.
    set (t' := cross (uh (S k)) (M k @ add (uh k) (smul (t / (len (uh k) * len (uh k))) (J (uh k)))) / al) in *.
    exists (al * a), t'; split; [|split; [|split]].
    + rewrite (exact k Lk), E.
      transitivity (smul a (M k @ add (uh k) (smul (t / (len (uh k) * len (uh k))) (J (uh k)))));
        [apply vec_ext; simpl; ring|].
      rewrite SF; apply vec_ext; simpl; ring.
    + apply (stepwise_cross (Rabs t') (Rabs t) (b k) (b (S k)) (len (uh (S k)) * len (r k)) (w k + c k) _ (omega k) (x k));
        try assumption; try lra; nra.
    + apply Rle_trans with ((1 - omega k) * (1 - w k)); [|apply Rmult_le_compat; lra].
      assert (0 <= omega k * w k) by (apply Rmult_le_pos; lra); nra.
    + (* (1 + omega)(1 - w - omega) <= 1 - w *)
      assert (0 < 1 - w (S k)) by lra.
      assert (A : al * a * (1 - w (S k)) <= (1 + omega k) * a * (1 - w k - omega k)).
      { apply Rmult_le_compat; [apply Rmult_le_pos; lra | lra | apply Rmult_le_compat_r; lra | lra]. }
      eapply Rle_trans; [exact A|].
      apply Rle_trans with (a * (1 - w k)); [|exact A2].
      replace ((1 + omega k) * a * (1 - w k - omega k)) with (a * ((1 + omega k) * (1 - w k - omega k))) by ring.
      apply Rmult_le_compat_l; [lra|].
      assert (0 <= omega k * w k) by (apply Rmult_le_pos; lra); nra.
Qed.
End Stepwise.

(** A kick that errs in v and a drift that errs in x turn the error by |r|/|uh| only, however strong they are. *)
Theorem shear_turn k t e y :
  Rabs (cross (Vec 0 e) (kick k @ J y)) <= Rabs e * len y /\
  Rabs (cross (Vec e 0) (drift t @ J y)) <= Rabs e * len y.
Proof.
  assert (V : Rabs (velocity y) <= len y /\ Rabs (position y) <= len y).
  { unfold len; rewrite <- !sqrt_Rsqr_abs; split; apply sqrt_le_1_alt; unfold Rsqr, dot; nra. }
  destruct V as [V X]; split.
  - replace (cross (Vec 0 e) (kick k @ J y)) with (e * velocity y) by (unfold kick; coordinates; ring).
    rewrite Rabs_mult; apply Rmult_le_compat_l; [apply Rabs_pos | exact V].
  - replace (cross (Vec e 0) (drift t @ J y)) with (e * position y) by (unfold drift; coordinates; ring).
    rewrite Rabs_mult; apply Rmult_le_compat_l; [apply Rabs_pos | exact X].
Qed.

(** ** Where kappa and g come from *)

Theorem contained_inverse M kappa :
  det M = 1 -> (forall y, len (M @ y) <= kappa * len y) -> forall y, len y <= kappa * len (M @ y).
Proof.
  intros D K y; pose proof (len_nonneg y) as [P|P]; [|rewrite <- P; pose proof (K y) as Ky].
  - apply Rmult_le_reg_l with (len y); [exact P|].
    rewrite len_sqr; replace (dot y y) with (cross (M @ y) (M @ J y)).
    2: { transitivity (det M * dot y y); [coordinates; ring | rewrite D; ring]. }
    eapply Rle_trans; [apply Rle_abs|]; eapply Rle_trans; [apply cross_le|].
    pose proof (K (J y)) as Kj; rewrite len_J in Kj; pose proof (len_nonneg (M @ y)); nra.
  - pose proof (len_nonneg (M @ y)); rewrite <- P in Ky.
    replace (len (M @ y)) with 0 by lra; lra.
Qed.

Theorem shrink_bound M uh r kappa eps :
  det M = 1 -> (forall y, len (M @ y) <= kappa * len y) ->
  0 <= kappa -> kappa * eps < 1 -> len r <= eps * len uh ->
  len uh <= kappa / (1 - kappa * eps) * len (add (M @ uh) r).
Proof.
  intros D K P S R; pose proof (contained_inverse M kappa D K uh) as I.
  pose proof (len_triangle (add (M @ uh) r) (smul (-1) r)) as T.
  rewrite len_smul, (Rabs_left (-1)) in T by lra.
  replace (add (add (M @ uh) r) (smul (-1) r)) with (M @ uh) in T by (apply vec_ext; coordinates; ring).
  apply Rmult_le_reg_l with (1 - kappa * eps); [lra|].
  replace ((1 - kappa * eps) * (kappa / (1 - kappa * eps) * len (add (M @ uh) r)))
    with (kappa * len (add (M @ uh) r)) by (field; lra).
  assert (kappa * len (M @ uh) <= kappa * (len (add (M @ uh) r) + eps * len uh)) by (apply Rmult_le_compat_l; lra).
  nra.
Qed.

Theorem update_contained k e o y :
  det (update k e o) = 1 /\ len (update k e o @ y) <= (1 + Rabs k * (e * e + o * o)) * len y.
Proof.
  split; [coordinates; ring|].
  set (f := Vec e o).
  replace (update k e o @ y) with (add y (smul (- (k * dot f y)) (J f))) by (apply vec_ext; coordinates; ring).
  eapply Rle_trans; [apply len_triangle|].
  rewrite len_smul, len_J, Rabs_Ropp, Rabs_mult.
  replace (e * e + o * o) with (len f * len f) by (rewrite len_sqr; coordinates; ring).
  pose proof (dot_le f y); pose proof (len_nonneg f); pose proof (Rabs_pos k).
  assert (Rabs (dot f y) * len f <= len f * len y * len f) by (apply Rmult_le_compat_r; assumption).
  assert (Rabs k * (Rabs (dot f y) * len f) <= Rabs k * (len f * len y * len f)) by (apply Rmult_le_compat_l; assumption).
  nra.
Qed.
